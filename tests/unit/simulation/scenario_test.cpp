#include <support/temporary_directory.hpp>

#include <gtest/gtest.h>

#include <libslam/config/help.hpp>
#include <libslam/config/yaml_loader.hpp>
#include <libslam/io/input_error.hpp>

#include "drive_fixture.hpp"

namespace libslam {
namespace {

using namespace libslam::testing;
using libslam::test::TemporaryDirectory;

template <class Error, class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(Scenario, EveryShippedOneIsValidAndDrives) {
  for (const char* name : {"sim_webmap", "sim_house", "sim_differential", "sim_stereo_features"}) {
    Scenario s = load_scenario(std::string(LIBSLAM_CONFIG_DIR "/") + name + ".yaml");
    EXPECT_NO_THROW(validate(s)) << name;
    s.drive.max_duration_s = 2.0;
    EXPECT_GT(drive(s, 1).size(), 10U) << name;
  }
}

TEST(Scenario, EffectiveFileReadsBackToTheSameValues) {
  Scenario s = small_scenario();
  s.truth.scale_left = 1.0 / 3.0;
  s.faults.kidnap.enabled = true;
  const TemporaryDirectory directory;
  const std::string text = to_yaml(ParameterTable(s));
  Scenario again = load_scenario(directory.write("s.yaml", text));
  EXPECT_EQ(to_yaml(ParameterTable(again)), text);
}

TEST(Scenario, HelpNamesEveryKey) {
  Scenario s;
  const std::string help = help_text(ParameterTable(s));
  for (const char* key : {"generator", "steering_rate_deg_s", "scale_left", "antenna_height",
                          "growth_per_m", "flavour"})
    EXPECT_NE(help.find(key), std::string::npos) << key;
}

TEST(Scenario, ConflictsAreNamed) {
  const auto first_conflict = [](auto change) {
    Scenario s = small_scenario();
    change(s);
    return message_of<ConfigError>([&] { validate(s); });
  };
  EXPECT_NE(first_conflict([](auto& s) {
              s.drive.observation_period_s = 0.03;
            }).find("drive.observation_period_s = 0.03"),
            std::string::npos);
  EXPECT_NE(first_conflict([](auto& s) { s.truth.track_width = 1.1; }).find("truth.track_width"),
            std::string::npos);
  EXPECT_NE(first_conflict([](auto& s) { s.drive.speed = -1; }).find("drive.speed"),
            std::string::npos);
  EXPECT_NE(first_conflict([](auto& s) { s.world.generator = "file"; }).find("landmarks_file"),
            std::string::npos);
  EXPECT_NE(first_conflict([](auto& s) {
              s.world.generator = "rooms";
              s.world.door_width = 9;
            }).find("door"),
            std::string::npos);
  EXPECT_NE(first_conflict([](auto& s) {
              s.log.odometry = "ticks";
              s.motion.model = "odometry_increment";
            }).find("log.odometry"),
            std::string::npos);
  EXPECT_NE(first_conflict([](auto& s) {
              s.range_bearing.sigma_range = 0;
            }).find("range_bearing.sigma_range"),
            std::string::npos);
  EXPECT_NE(first_conflict([](auto& s) {
              s.faults.noise_step = {true, 5.0, 4.0, 2.0};
            }).find("faults.noise_step.end_s"),
            std::string::npos);
}

class WorldFiles : public ::testing::Test {
 protected:
  Scenario scenario() {
    directory_.write("s.yaml",
                     "world: {generator: file, landmarks_file: l.csv, way_points_file: w.csv, "
                     "walls_file: walls.csv}\n");
    return load_scenario(directory_.path() / "s.yaml");
  }
  void write(const std::string& landmarks, const std::string& way_points,
             const std::string& walls) {
    directory_.write("l.csv", landmarks);
    directory_.write("w.csv", way_points);
    directory_.write("walls.csv", walls);
  }
  std::string rejection() {
    return message_of<InputError>([&] { make_world(scenario()); });
  }

  TemporaryDirectory directory_;
};

TEST_F(WorldFiles, AreFoundBesideTheScenario) {
  write("id,x,y\n7,1,2\n", "id,x,y\n1,10,0\n2,0,10\n", "x1,y1,x2,y2\n0,0,1,1\n");
  const World world = make_world(scenario());
  ASSERT_EQ(world.landmarks.size(), 1U);
  EXPECT_EQ(world.landmarks[0].id, 7);
  EXPECT_EQ(world.way_points[1], Eigen::Vector2d(0, 10));
  EXPECT_EQ(world.walls[0].to, Eigen::Vector2d(1, 1));
}

TEST_F(WorldFiles, AreRejectedByFileAndRow) {
  const std::string points = "id,x,y\n1,10,0\n", walls = "0,0,1,1\n";
  write("id,x,y\n1,2,nan\n", points, walls);
  EXPECT_NE(rejection().find("l.csv:2: "), std::string::npos);
  write("id,x,y\n-5,2,3\n", points, walls);
  EXPECT_NE(rejection().find("landmark id -5"), std::string::npos);
  write(points, "id,x,y\n1,2\n", walls);
  EXPECT_NE(rejection().find("w.csv:2: "), std::string::npos);
  write(points, points, "x1,y1,x2,y2\n0,0,1,1\n0,0,1\n");
  EXPECT_NE(rejection().find("walls.csv:3: "), std::string::npos);
  std::filesystem::remove(directory_.path() / "w.csv");
  EXPECT_NE(rejection().find("w.csv: no such file"), std::string::npos);
}

}  // namespace
}  // namespace libslam
