#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/obs/CActionRobotMovement2D.h>

#include <libslam/state/planar_pose.hpp>

#include "drive_fixture.hpp"

namespace libslam {
namespace {

using namespace libslam::testing;
using mrpt::obs::CObservationBearingRange;

TEST(Simulator, SameSeedSameDriveOtherSeedOtherDrive) {
  const Scenario s = small_scenario();
  const auto a = drive(s, 3), b = drive(s, 3), c = drive(s, 4);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].T_world_robot, b[i].T_world_robot);
  EXPECT_NE(a.back().T_world_robot, c.back().T_world_robot);
}

TEST(Simulator, BeginsAtTheStartWithAnObservationAndKeepsItsPeriods) {
  const Scenario s = small_scenario();
  const auto steps = drive(s, 1);
  EXPECT_EQ(steps.front().step.action, nullptr);
  EXPECT_NE(steps.front().step.frame, nullptr);
  EXPECT_EQ(steps.front().T_world_robot, make_simulator(s, 1)->start());
  EXPECT_EQ(steps.size(), 801U);  // 20 s of .025 s and the start
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_EQ(steps[i].step.index, static_cast<std::int64_t>(i));
    EXPECT_EQ(steps[i].step.frame != nullptr, i % 8 == 0) << i;
    EXPECT_NEAR(steps[i].step.time - steps[0].step.time, 0.025 * static_cast<double>(i), 1e-6);
    // Doubles hold seconds since 1970 to 2.4e-7 s.
    EXPECT_NEAR(steps[i].step.dt, i > 0 ? 0.025 : 0.0, 3e-7);
  }
}

TEST(Simulator, WithoutNoiseTheTruthIsTheLogTimesTheTrueScale) {
  Scenario s = small_scenario();
  s.motion.noise.along_per_sqrt_s = s.motion.noise.steering_per_sqrt_s = 0.0;
  s.truth.scale_left = s.truth.scale_right = 1.05;
  const auto steps = drive(s, 1);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const auto motion = steps[i].step.action->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
    const double logged = motion->poseChange->getMeanVal().norm();
    const double driven = (steps[i].T_world_robot - steps[i - 1].T_world_robot).head<2>().norm();
    ASSERT_NEAR(driven, 1.05 * logged, 1e-9);
  }
}

struct NoiseCase {
  const char* model;
  const char* form;
};

class MotionNoise : public ::testing::TestWithParam<NoiseCase> {};

/// What the log claims about its increments is how the truth scatters about them: the normalized
/// squares sum up to a chi-square number.
TEST_P(MotionNoise, IsTheCovarianceOfTheLog) {
  Scenario s = small_scenario();
  s.motion.model = GetParam().model;
  s.motion.ackermann_form = GetParam().form;
  s.motion.noise.across_per_sqrt_s = 0.01;
  s.motion.noise.turn_per_sqrt_s = 0.01;
  double sum = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto steps = drive(s, seed);
    for (std::size_t i = 1; i < steps.size(); ++i) {
      const auto motion =
          steps[i].step.action->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
      const auto [cov, mean] = motion->poseChange->getCovarianceAndMean();
      const Eigen::Vector3d error =
          relative_pose(steps[i - 1].T_world_robot, steps[i].T_world_robot) -
          Eigen::Vector3d(mean.x(), mean.y(), mean.phi());
      sum += error.dot(cov.asEigen().inverse() * error);
      ++count;
    }
  }
  // Chi-square with 3 n degrees of freedom: standard deviation sqrt(6 n). Four of them, and one
  // thousandth for what a linearization leaves out.
  EXPECT_NEAR(sum / count, 3.0, 4.0 * std::sqrt(6.0 / count) + 3e-3);
}

INSTANTIATE_TEST_SUITE_P(Models, MotionNoise,
                         ::testing::Values(NoiseCase{"ackermann", "seed"},
                                           NoiseCase{"ackermann", "rear_axle"},
                                           NoiseCase{"ackermann", "front_axle"},
                                           NoiseCase{"differential", "seed"},
                                           NoiseCase{"odometry_increment", "seed"}));

TEST(Simulator, MergedPairsAreThePairsBetweenObservations) {
  Scenario s = small_scenario();
  const auto pairs = drive(s, 2);
  s.log.flavour = "merged_pairs";
  const auto merged = drive(s, 2);
  ASSERT_EQ(merged.size(), 101U);
  for (std::size_t i = 0; i < merged.size(); ++i) {
    EXPECT_EQ(merged[i].T_world_robot, pairs[8 * i].T_world_robot);
    EXPECT_EQ(merged[i].step.time, pairs[8 * i].step.time);
    EXPECT_NE(merged[i].step.frame, nullptr);
  }
}

TEST(Simulator, CalibrationNamesWhatAFilterWouldFind) {
  Scenario s = small_scenario();
  s.truth.scale_left = s.truth.scale_right = 1.05;
  s.truth.bias_steering_deg = 1.0;
  const auto ackermann = make_simulator(s, 1)->calibration();
  EXPECT_DOUBLE_EQ(ackermann.at("scale_left"), 1.05);
  EXPECT_DOUBLE_EQ(ackermann.at("scale_speed"), 1.05);
  EXPECT_DOUBLE_EQ(ackermann.at("bias_steering"), kPi / 180.0);
  s = differential_scenario();
  s.truth.track_width = 1.1;
  const auto differential = make_simulator(s, 1)->calibration();
  EXPECT_DOUBLE_EQ(differential.at("track_width"), 1.1);
  EXPECT_FALSE(differential.contains("bias_steering"));
}

TEST(Simulator, AWayPointThatCannotBeReachedIsAnError) {
  Scenario s = small_scenario();
  s.drive.max_duration_s = 0.0;
  s.drive.steering_limit_deg = 0.5;
  s.drive.way_point_radius = 0.01;
  EXPECT_THROW(drive(s, 1), std::runtime_error);
}

TEST(Simulator, DrivesTheWholeLapAndEndsAtTheLastWayPoint) {
  Scenario s = small_scenario();
  s.drive.max_duration_s = 0.0;
  const auto simulator = make_simulator(s, 1);
  Eigen::Vector3d last = simulator->start();
  while (const auto step = simulator->next()) last = step->T_world_robot;
  EXPECT_EQ(simulator->progress(), 1.0);
  EXPECT_LT((last.head<2>() - simulator->world().way_points.back()).norm(), 1.0);
}

/// Figures of the published map of this shape (35 landmarks, 17 way-points): 1.067 landmarks in
/// view on average, none in 23.4 % of the observations.
TEST(Simulator, WebmapHasThePublishedVisibility) {
  Scenario s = load_scenario(LIBSLAM_CONFIG_DIR "/sim_webmap.yaml");
  validate(s);
  s.truth = {};
  const auto simulator = make_simulator(s, 1);
  EXPECT_EQ(simulator->landmarks().size(), 35U);
  EXPECT_EQ(simulator->world().way_points.size(), 17U);
  double sightings = 0, blind = 0, observations = 0, turned = 0, length = 0;
  Eigen::Vector3d before = simulator->start();
  while (const auto step = simulator->next()) {
    turned += wrap_angle(step->T_world_robot.z() - before.z());
    length += (step->T_world_robot - before).head<2>().norm();
    before = step->T_world_robot;
    const auto seen = observation_of<CObservationBearingRange>(*step);
    if (!seen) continue;
    ++observations;
    sightings += static_cast<double>(seen->sensedData.size());
    blind += seen->sensedData.empty() ? 1 : 0;
  }
  EXPECT_NEAR(sightings / observations, 1.067, 0.2 * 1.067);
  EXPECT_NEAR(blind / observations, 0.234, 0.2 * 0.234);
  EXPECT_NEAR(turned, 2 * kPi, 1.0);
  EXPECT_NEAR(length, 600.0, 35.0);
}

}  // namespace
}  // namespace libslam
