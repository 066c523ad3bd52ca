#include <limits>
#include <tests/support/slam_world.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/association/known.hpp>
#include <libslam/association/nearest_neighbour.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/measurement/range_bearing.hpp>
#include <libslam/motion/odometry_increment.hpp>

using namespace libslam;
using libslam::testing::SlamWorld;

namespace {

EkfSlamParts parts_with(const char* frame, bool known = true) {
  EkfSlamParts parts;
  parts.motion = std::make_unique<OdometryIncrement>(MotionParameters{}, CalibrationParameters{});
  parts.measurement = std::make_unique<RangeBearing>();
  if (known)
    parts.associator = std::make_unique<KnownAssociation>(std::numeric_limits<double>::infinity());
  else
    parts.associator = std::make_unique<NearestNeighbour>(11.8, 40.0);
  parts.frame = make_error_frame(frame);
  return parts;
}

}  // namespace

TEST(EkfSlam, NoiselessRunsReachZeroError) {
  for (const char* frame : {"standard", "right_invariant"})
    for (const bool known : {true, false}) {
      std::mt19937_64 random(61);
      SlamWorld world;
      EkfSlam filter(parts_with(frame, known));
      for (int k = 0; k < 300; ++k) {
        const MotionAction action = world.drive(random, 0.0);
        filter.propagate(&action);
        filter.update(world.observe(random, 0.0));
      }
      const Eigen::Vector3d estimate = filter.state().estimate(filter.pose());
      EXPECT_LT((estimate.head<2>() - world.pose.head<2>()).norm(), 1e-9) << frame;
      EXPECT_LT(std::abs(wrap_angle(estimate[2] - world.pose[2])), 1e-9) << frame;
      const auto map = filter.landmarks();
      ASSERT_EQ(map.size(), filter.registry().size());
      EXPECT_GT(map.size(), 12u);
      for (const auto& landmark : map) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& truth : world.landmarks)
          nearest = std::min(nearest, (landmark.mean - truth).norm());
        EXPECT_LT(nearest, 1e-9);
      }
      EXPECT_TRUE(filter.healthy());
    }
}

// Without noise all points of linearization are the same point.
TEST(EkfSlam, PointsOfLinearizationAgreeWithoutNoise) {
  const auto covariance_after = [](const char* frame, std::unique_ptr<LinearizationPoint> point,
                                   TrueState* truth) {
    std::mt19937_64 random(63);
    SlamWorld world;
    EkfSlamParts parts = parts_with(frame);
    parts.linearization = std::move(point);
    EkfSlam filter(std::move(parts));
    for (int k = 0; k < 100; ++k) {
      const MotionAction action = world.drive(random, 0.0);
      if (truth != nullptr) truth->pose = world.pose;
      filter.propagate(&action);
      filter.update(world.observe(random, 0.0));
    }
    return filter.state().full_covariance();
  };
  TrueState truth;
  const SlamWorld world;
  for (std::size_t i = 0; i < world.landmarks.size(); ++i)
    truth.landmarks[static_cast<std::int64_t>(i)] = world.landmarks[i];
  const Eigen::MatrixXd reference = covariance_after("standard", nullptr, nullptr);
  EXPECT_LT((covariance_after("right_invariant", nullptr, nullptr) - reference).norm(), 1e-11);
  EXPECT_LT((covariance_after("standard", std::make_unique<FirstEstimates>(), nullptr) - reference)
                .norm(),
            1e-11);
  EXPECT_LT((covariance_after("standard", std::make_unique<TruthPoint>(truth), &truth) - reference)
                .norm(),
            1e-11);
}

TEST(EkfSlam, KeepsThePointOfLinearizationThroughStepsWithoutOdometry) {
  TrueState truth;
  EkfSlamParts parts = parts_with("standard");
  parts.linearization = std::make_unique<TruthPoint>(truth);
  parts.cov_start = Eigen::Matrix3d::Identity();
  EkfSlam filter(std::move(parts));
  truth.pose = Eigen::Vector3d(3.0, 4.0, 0.5);  // moved unseen
  filter.propagate(nullptr);
  // x of the error is now that of the place (3, 4): a turn by e about the origin moves it by -4 e.
  EXPECT_NEAR(filter.state().cross_covariance(filter.pose(), filter.pose())(0, 2), -4.0, 1e-12);
}

TEST(EkfSlam, StepsWithoutOdometryAddTheirNoise) {
  EkfSlamParts parts = parts_with("standard");
  parts.cov_no_odometry = Eigen::Vector3d(0.1, 0.2, 0.3).cwiseAbs2().asDiagonal();
  EkfSlam filter(std::move(parts));
  filter.propagate(nullptr);
  filter.propagate(nullptr);
  EXPECT_LT(
      (filter.state().covariance_of(filter.pose()).diagonal() - Eigen::Vector3d(0.02, 0.08, 0.18))
          .norm(),
      1e-15);
}

TEST(EkfSlam, RefusesMissingParts) {
  EkfSlamParts parts = parts_with("standard");
  parts.motion.reset();
  EXPECT_THROW(EkfSlam{std::move(parts)}, std::invalid_argument);
}
