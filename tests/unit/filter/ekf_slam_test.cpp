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

/// n^T P^-1 n for the direction n along which a turn of the world moves the state at `filter`.
double information_on_world_turn(const EkfSlam& filter) {
  const GaussianState& state = filter.state();
  Eigen::VectorXd n = Eigen::VectorXd::Zero(state.dimension());
  for (const BlockId block : state.blocks()) {
    const auto x = state.estimate(block);
    n.segment<2>(state.offset(block)) = Eigen::Vector2d(-x[1], x[0]);
  }
  n[state.offset(filter.pose()) + 2] = 1.0;
  return n.dot(state.full_covariance().ldlt().solve(n));
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

// A turn of the whole world changes no measurement, so no update may add information about it.
TEST(EkfSlam, RightInvariantGainsNothingAlongTheUnobservableTurn) {
  double gained[2] = {0.0, 0.0};
  for (const int which : {0, 1}) {
    std::mt19937_64 random(62);
    SlamWorld world;
    world.sigma_turn = 0.05;  // large enough for linearization points to wander
    EkfSlamParts parts = parts_with(which == 0 ? "right_invariant" : "standard");
    parts.cov_start = Eigen::Vector3d(0.1, 0.1, 0.1).cwiseAbs2().asDiagonal();
    EkfSlam filter(std::move(parts));
    filter.update(world.observe(random, 1.0));
    for (int k = 0; k < 100; ++k) {
      const MotionAction action = world.drive(random, 1.0);
      filter.propagate(&action);
      const double before = information_on_world_turn(filter);
      filter.update(world.observe(random, 1.0));
      const double after = information_on_world_turn(filter);
      gained[which] += std::max(0.0, after - before) / before;
    }
  }
  EXPECT_LT(gained[0], 1e-6);  // rounding of a 70-state inverse, 100 steps
  EXPECT_GT(gained[1], 0.1);   // the same check fails for the standard frame
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
