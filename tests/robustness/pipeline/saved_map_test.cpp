// --save-map and --load-map as a user meets them.

#include <support/program_run.hpp>

#include <nlohmann/json.hpp>

namespace libslam {
namespace {

using namespace libslam::test;

const std::string kRun = LIBSLAM_SLAM_RUN;
const std::string kConfig = LIBSLAM_CONFIG_DIR "/range_bearing.yaml";

class SavedMapRun : public ProgramTest {
 protected:
  Outcome slam_run(const std::string& arguments, const std::string& log = kGoodLog) const {
    return run(kRun + " " + kConfig + " " + log + " --force --set output.report=false --out " +
               path("run") + " " + arguments);
  }
  nlohmann::json summary() const { return nlohmann::json::parse(read_all(path("run/run.json"))); }
  std::string saved() const {
    EXPECT_EQ(slam_run("--save-map " + path("hall.slammap")).code, 0);
    return path("hall.slammap");
  }
  void expect_refused(const Outcome& outcome, int code, const std::string& text) const {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  }
};

TEST_F(SavedMapRun, AMapIsWrittenReadAndNamed) {
  const std::string map = saved();
  EXPECT_EQ(read_all(path("hall.csv")), read_all(path("run/map.csv")));
  EXPECT_FALSE(summary()["input"].contains("map"));
  const std::string start = " --set map.start=given_pose";
  EXPECT_EQ(slam_run("--load-map " + map + start).code, 0);
  EXPECT_EQ(summary()["input"]["map"]["file"], map);
  EXPECT_EQ(summary()["input"]["map"]["sha256"].get<std::string>().size(), 64u);
  EXPECT_EQ(summary()["result"]["landmarks"], 70);
  // The landmarks are given: the map at the end is the map at the start but for the sightings.
  EXPECT_EQ(slam_run("--load-map " + map + start + " --save-map " + path("again.slammap")).code, 0);
  const auto first_cells = [&](const std::string& file) {
    std::istringstream lines(read_all(path(file)));
    std::string all;
    for (std::string line; std::getline(lines, line);) all += line.substr(0, line.rfind(','));
    return all;
  };
  EXPECT_EQ(first_cells("again.csv"), first_cells("hall.csv"));
  // The effective configuration names the map, and reproduces the run.
  const std::string trajectory = read_all(path("run/trajectory.csv"));
  EXPECT_EQ(
      run(kRun + " " + path("run/config.yaml") + " " + kGoodLog + " --out " + path("same")).code,
      0);
  EXPECT_EQ(read_all(path("same/trajectory.csv")), trajectory);
}

TEST_F(SavedMapRun, SlamContinuesWhereItEnded) {
  const std::string map = saved();
  const auto pose = summary()["result"]["pose"];
  const std::string still = odometry_log(3, [](int, auto& o) { o.odometry = {0.0, 0.0, 0.0}; });
  EXPECT_EQ(slam_run("--load-map " + map + " --set map.mode=continue", still).code, 0);
  EXPECT_EQ(summary()["result"]["pose"], pose);
  EXPECT_EQ(summary()["result"]["landmarks"], 70);
}

TEST_F(SavedMapRun, BadMapsAreOneLineAndExitFour) {
  const std::string good = read_all(saved());
  write("empty.slammap", "");
  write("short.slammap", good.substr(0, good.size() / 2));
  write("head.slammap", good.substr(0, 20));
  write("noise.slammap", std::string(1000, '\x5a'));
  write("binary.slammap", std::string(100, '\0'));
  std::string flipped = good;
  flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 1);
  write("flipped.slammap", flipped);
  std::string version = good;
  version[8] = 9;
  write("version.slammap", version);
  std::string huge = good;
  for (std::size_t i = 40; i < 48; ++i) huge[i] = '\xff';
  write("huge.slammap", huge);
  for (const char* name :
       {"empty", "short", "head", "noise", "binary", "flipped", "version", "huge", "none"}) {
    std::filesystem::remove_all(path("run"));
    const std::string file = std::string(name) + ".slammap";
    expect_refused(slam_run("--load-map " + path(file)), 4, file);
    EXPECT_FALSE(std::filesystem::exists(path("run"))) << name;
  }
  expect_refused(slam_run("--load-map " + path(".")), 4, path("."));
  expect_refused(slam_run("--load-map " + path("hall.csv")), 4, "--save-map");
}

TEST_F(SavedMapRun, WhatDoesNotFitIsExitThree) {
  write("survey.csv", "id,x,y\n1,2,3\n");
  write("space.csv", "id,x,y,z\n1,2,3,4\n");
  std::filesystem::remove_all(path("run"));
  expect_refused(slam_run("--load-map " + path("survey.csv")), 3, "given_pose");
  expect_refused(slam_run("--set map.start=given_pose --load-map " + path("space.csv")), 3,
                 "3 coordinates");
  expect_refused(slam_run("--load-map x --set filter.error_frame=standard --set "
                          "filter.linearization=first_estimate"),
                 3, "map.file");
  expect_refused(slam_run("--set map.mode=explore --load-map x"), 3, "localize");
  EXPECT_FALSE(std::filesystem::exists(path("run")));
}

TEST_F(SavedMapRun, AMapThatCannotBeWrittenIsSaidBeforeTheRun) {
  expect_refused(slam_run("--save-map " + path("none/hall.slammap")), 2, "none");
  EXPECT_FALSE(std::filesystem::exists(path("run")));
  EXPECT_EQ(slam_run("--save-map " + path("hall.csv")).code, 2);
  // Found out at the end alone: what was computed is not lost.
  std::filesystem::create_directories(path("taken.slammap/x"));
  EXPECT_EQ(slam_run("--save-map " + path("taken.slammap")).code, 2);
  EXPECT_EQ(summary()["exit_code"], 2);
  EXPECT_GT(read_all(path("run/trajectory.csv")).size(), 1000u);
}

}  // namespace
}  // namespace libslam
