// Data sets of stereo cameras in space: small invented ones, and the real ones where they are.

#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <support/temporary_directory.hpp>

#include <gtest/gtest.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationStereoImagesFeatures.h>

#include <libslam/io/importers/kitti_features.hpp>
#include <libslam/io/importers/starry_night.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/log_inspection.hpp>
#include <libslam/io/truth_reader.hpp>

#include "data_directory.hpp"
#include "log_builder.hpp"

namespace libslam::test {
namespace {

using Files = std::map<std::string, std::string>;

Files starry_files() {
  return {{"params.txt",
           "C_c_v = 0 -1 0 0 0 -1 1 0 0\nrho_v_c_v = 0.1 0 0.2\nfu = 480\nfv = 481\ncu = 320\n"
           "cv = 240\nb = 0.24\nv_var = 0.01 0.04 0.09\nw_var = 1 4 9\ny_var = 1 4 1 4\n"},
          {"landmarks.csv", "# j,x,y,z\n1,5,0,0.5\n2,6,1,1\n"},
          {"groundtruth_and_imu.csv",
           "1,10,0,0,0,0,0,0,1,0,0,0,0,0.5\n2,10.5,0,0,0.25,0.5,0,0.1,2,0,0,0,0,0\n"},
          {"stereo_observations.csv", "1,10,1,330,250,310,251\n2,10.5,2,331,250,311,251\n"}};
}

Files kitti_files() {
  return {{"calib.txt",
           "K = 700 0 600 0 701 180 0 0 1\nbaseline = 0.5\n"
           "cam_T_imu = 0 -1 0 0 0 0 -1 0 1 0 0 0.5 0 0 0 1\n"},
          {"imu_velocity.csv", "0,100,9,0,0,0,0,0\n1,100.5,2,0,0,0,0,0.1\n"},
          {"stereo_features.csv", "0,7,610,190,600,190\n1,7,612,190,601,190\n5,8,1,1,0,1\n"},
          {"gt_poses_seq07.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n"}};
}

class SpatialImport : public testing::Test {
 protected:
  std::string write(const Files& files) const {
    for (const auto& [name, text] : files) std::ofstream(directory_.path() / name) << text;
    return directory_.path().string();
  }
  std::string rawlog() const { return (directory_.path() / "x.rawlog").string(); }

 private:
  TemporaryDirectory directory_;
};

TEST_F(SpatialImport, StarryNightRowDrivesToTheNextStep) {
  const SpatialLog log = import_starry_night(write(starry_files()));
  ASSERT_EQ(log.steps.size(), 2U);
  EXPECT_EQ(log.steps[0].twist.norm(), 0.0);
  EXPECT_EQ(log.steps[1].twist[0], 1.0);
  EXPECT_EQ(log.steps[1].twist[5], 0.5);
  EXPECT_EQ(log.parameters.at("sigma_rate_z"), 3.0);
  EXPECT_EQ(starry_night_sigma(log), Eigen::Vector4d(1, 2, 1, 2));
  // The axis of the camera is the first of the vehicle.
  const Eigen::Vector3d ahead = log.camera.T_robot_camera * Eigen::Vector3d(0, 0, 1);
  EXPECT_LT((ahead - Eigen::Vector3d(1.1, 0, 0.2)).norm(), 1e-12);
}

TEST_F(SpatialImport, KittiRowDrivesFromTheStepBeforeAndTheWorldIsTheFirstRobot) {
  const SpatialLog log = import_kitti_features(write(kitti_files()));
  ASSERT_EQ(log.steps.size(), 2U);
  EXPECT_EQ(log.steps[1].twist[0], 2.0);
  EXPECT_EQ(log.steps[1].sightings.size(), 1U);
  ASSERT_EQ(log.truth.path.spatial.size(), 2U);
  EXPECT_LT(log.truth.path.spatial[0].position.norm(), 1e-12);
  EXPECT_LT((log.truth.path.spatial[1].position - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
}

TEST_F(SpatialImport, RoundTripThroughTheRawlog) {
  const SpatialLog log = import_starry_night(write(starry_files()));
  ASSERT_TRUE(write_spatial_log(log, rawlog()));
  RawlogPlayer player(rawlog(), with_policy("strict"));
  const auto steps = play(player);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_TRUE(player.is_pair_log());
  EXPECT_NEAR(steps[1].dt, 0.5, 1e-6);
  const auto motion = steps[1].action->getActionByClass<mrpt::obs::CActionRobotMovement3D>();
  ASSERT_TRUE(motion);
  EXPECT_FLOAT_EQ(motion->velocities[3], 0.5F);  // yaw
  EXPECT_NEAR(motion->poseChange.mean.yaw(), 0.25, 1e-9);
  const auto seen =
      steps[1].frame->getObservationByClass<mrpt::obs::CObservationStereoImagesFeatures>();
  ASSERT_EQ(seen->theFeatures.size(), 1U);
  EXPECT_EQ(seen->theFeatures[0].ID, 2U);
  EXPECT_EQ(seen->theFeatures[0].pixels.second.x, 311.0F);
  const GroundTruth truth = read_truth(find_truth(rawlog()));
  ASSERT_EQ(truth.path.spatial.size(), 2U);
  EXPECT_NEAR(truth.path.spatial[1].rotation.z(), std::sin(0.125), 1e-9);
  ASSERT_EQ(truth.landmarks.size(), 2U);
  EXPECT_EQ(truth.landmarks[1].position, Eigen::Vector3d(6, 1, 1));
}

TEST_F(SpatialImport, InspectionKnowsMotionsInSpace) {
  ASSERT_TRUE(write_spatial_log(import_starry_night(write(starry_files())), rawlog()));
  RawlogPlayer player(rawlog(), with_policy("strict"));
  LogInspection inspection;
  for (const LogStep& step : play(player)) inspection.observe(step);
  const OdometryStatistics& odometry = inspection.odometry();
  EXPECT_EQ(odometry.motions, 1);
  EXPECT_EQ(odometry.velocities_agree, 1);
  EXPECT_NEAR(odometry.total_turn, 0.25, 1e-9);
  // The chord of .5 s at 1 m/s and .5 rad/s.
  EXPECT_NEAR(odometry.path_length, 2.0 * std::sin(0.125) / 0.5, 1e-9);
}

TEST_F(SpatialImport, SimulatedPixelsAreProjectionsWithTheStatedNoise) {
  SpatialLog exact = import_starry_night(write(starry_files()));
  simulate_pixels(exact, Eigen::Vector4d::Zero(), 1);
  const Eigen::Vector4d& z = exact.steps[0].sightings.at(0).pixels;
  // Landmark 1 at (5, 0, .5), the camera at (.1, 0, .2) looking along x: depth 4.9, .3 above.
  const Eigen::Vector4d expected(320.0, 240.0 - 481.0 * 0.3 / 4.9, 320.0 - 480.0 * 0.24 / 4.9,
                                 240.0 - 481.0 * 0.3 / 4.9);
  EXPECT_LT((z - expected).norm(), 1e-9);
  SpatialLog a = import_starry_night(write(starry_files())), b = a;
  simulate_pixels(a, Eigen::Vector4d::Ones(), 2);
  simulate_pixels(b, Eigen::Vector4d::Ones(), 2);
  EXPECT_EQ(a.steps[0].sightings[0].pixels, b.steps[0].sightings[0].pixels);
  EXPECT_NE(a.steps[0].sightings[0].pixels, expected);
}

struct Defect {
  const char* file;
  const char* text;
  const char* message;
};

std::string message_of(const std::function<void()>& import) {
  try {
    import();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(SpatialImport, NamesTheFileAndPlaceOfADefect) {
  const std::vector<Defect> starry = {
      {"groundtruth_and_imu.csv", "1,10,0,0,0,0,0,0,1,0,0,0,0\n", ":1: expected at least 14"},
      {"groundtruth_and_imu.csv", "3,10,0,0,0,0,0,0,1,0,0,0,0,0\n", ":1: k does not count"},
      {"groundtruth_and_imu.csv", "1,10,0,0,0,0,0,0,1,0,0,0,0,0\n2,10,0,0,0,0,0,0,1,0,0,0,0,0\n",
       ":2: time does not"},
      {"stereo_observations.csv", "3,10,1,330,250,310,251\n", ":1: no such step"},
      {"stereo_observations.csv", "1,10,1,330,nan,310,251\n", ":1:"},
      {"params.txt", "fu = 480\n", "must have"}};
  for (const Defect& defect : starry) {
    Files files = starry_files();
    files[defect.file] = defect.text;
    const std::string directory = write(files);
    const std::string message = message_of([&] { import_starry_night(directory); });
    EXPECT_NE(message.find(defect.file), std::string::npos) << message;
    EXPECT_NE(message.find(defect.message), std::string::npos) << message;
  }
  const std::vector<Defect> kitti = {
      {"imu_velocity.csv", "1,100,9,0,0,0,0,0\n", ":1: frames do not count"},
      {"stereo_features.csv", "0,-7,610,190,600,190\n", ":1: feature id"},
      {"gt_poses_seq07.txt", "1 0 0 0 0 2 0 0 0 0 1 0\n", ":1: the matrix holds no rotation"},
      {"calib.txt", "K = 700 0 600 0 701 180 0 0 1\n", "are needed"}};
  for (const Defect& defect : kitti) {
    Files files = kitti_files();
    files[defect.file] = defect.text;
    const std::string directory = write(files);
    const std::string message = message_of([&] { import_kitti_features(directory); });
    EXPECT_NE(message.find(defect.file), std::string::npos) << message;
    EXPECT_NE(message.find(defect.message), std::string::npos) << message;
  }
}

// What the data set states about itself (README): noise of the pixels at the true poses.
TEST_F(SpatialImport, StarryNightResidualsHaveTheStatedNoise) {
  const std::string directory = data_set("utias_starry_night");
  if (directory.empty()) GTEST_SKIP() << "utias_starry_night is not there";
  SpatialLog log = import_starry_night(directory);
  SpatialLog exact = log;
  simulate_pixels(exact, Eigen::Vector4d::Zero(), 0);
  Eigen::Vector4d squares = Eigen::Vector4d::Zero();
  double count = 0.0;
  for (std::size_t k = 0; k < log.steps.size(); ++k) {
    ASSERT_EQ(log.steps[k].sightings.size(), exact.steps[k].sightings.size());
    for (std::size_t i = 0; i < log.steps[k].sightings.size(); ++i) {
      squares +=
          (log.steps[k].sightings[i].pixels - exact.steps[k].sightings[i].pixels).cwiseAbs2();
      ++count;
    }
  }
  EXPECT_EQ(count, 9410);
  const Eigen::Vector4d ratio =
      (squares / count).cwiseSqrt().cwiseQuotient(starry_night_sigma(log));
  EXPECT_LT((ratio.array() - 1.0).abs().maxCoeff(), 0.1) << ratio.transpose();
}

}  // namespace
}  // namespace libslam::test
