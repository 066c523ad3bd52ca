#include <limits>
#include <random>
#include <tests/support/slam_world.hpp>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <libslam/association/known.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/measurement/range_bearing.hpp>
#include <libslam/motion/odometry_increment.hpp>
#include <libslam/state/chi_square.hpp>

using namespace libslam;
using libslam::testing::SlamWorld;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

EkfSlamParts parts_with(const char* frame, const DelayedPoseSpacing& spacing) {
  EkfSlamParts parts;
  parts.motion = std::make_unique<OdometryIncrement>(MotionParameters{}, CalibrationParameters{});
  parts.measurement = std::make_unique<RangeBearing>();
  parts.associator = std::make_unique<KnownAssociation>(kInfinity);
  parts.frame = make_error_frame(frame);
  parts.delayed.emplace(spacing);
  return parts;
}

struct Drive {
  Trajectory smoothed;
  std::vector<Eigen::Vector3d> on_line, truth;
  GaussianState state;
};

/// Two laps of a circle of 20 m with what little the sensor sees within 4 m.
Drive drive(const char* frame, std::uint64_t seed, double noise,
            const DelayedPoseSpacing& spacing) {
  std::mt19937_64 random(seed);
  SlamWorld world;
  world.sensor_range = 4.0;
  EkfSlam filter(parts_with(frame, spacing));
  Drive run;
  for (int k = 0; k < 250; ++k) {
    const MotionAction action = world.drive(random, noise);
    filter.propagate(&action);
    filter.update(world.observe(random, noise));
    filter.remember_pose(k);
    run.truth.push_back(world.pose);
    run.on_line.emplace_back(filter.state().estimate(filter.pose()));
  }
  run.smoothed = *filter.smoothed_path();
  run.state = filter.state();
  return run;
}

double squared_error(const std::vector<Eigen::Vector3d>& path, const Drive& run) {
  double sum = 0.0;
  for (std::size_t k = 0; k < path.size(); ++k)
    sum += (path[k] - run.truth[k]).head<2>().squaredNorm();
  return sum;
}

}  // namespace

TEST(DelayedPoses, NoiselessPathIsTheTrueOne) {
  for (const char* frame : {"standard", "right_invariant"})
    for (const double distance : {0.1, 3.0, 1e6}) {
      const Drive run = drive(frame, 5, 0.0, {distance, kInfinity});
      ASSERT_EQ(run.smoothed.poses.size(), run.truth.size());
      for (std::size_t k = 0; k < run.truth.size(); ++k) {
        const Eigen::Vector3d d = run.smoothed.poses[k] - run.truth[k];
        EXPECT_LT(d.head<2>().norm() + std::abs(wrap_angle(d.z())), 1e-8) << frame << distance << k;
      }
    }
}

TEST(DelayedPoses, AreKeptByDistanceAndByTurn) {
  // 250 steps of .5 m and .05 rad on a circle of 10 m radius; the first pose is kept, too, and
  // comes after the first step.
  const std::size_t one = drive("standard", 1, 0.0, {1e6, 1e6}).state.blocks().size();
  EXPECT_EQ(drive("standard", 1, 0.0, {1e6, 0.49}).state.blocks().size(), one + 249 / 10);
  EXPECT_EQ(drive("standard", 1, 0.0, {4.9, 1e6}).state.blocks().size(), one + 249 / 10);
}

// The second lap teaches where the first was: 20 seeds, and the whole sum must be better by a
// fifth; single seeds gain between 15 and 80 % in squared error.
TEST(DelayedPoses, LaterSightingsCorrectThePast) {
  for (const char* frame : {"standard", "right_invariant"}) {
    double smoothed = 0.0, on_line = 0.0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Drive run = drive(frame, seed, 1.0, {1.0, 0.5});
      smoothed += squared_error(run.smoothed.poses, run);
      on_line += squared_error(run.on_line, run);
    }
    EXPECT_LT(smoothed, 0.8 * on_line) << frame;
  }
}

// A kept pose has the covariance that its error says: mean NEES of 60 runs within the 99.9 %
// interval of chi-square with 3 x 60 degrees of freedom.
TEST(DelayedPoses, AreAsCertainAsTheyClaim) {
  for (const char* frame : {"standard", "right_invariant"}) {
    constexpr int kRuns = 60;
    double nees = 0.0;
    for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
      const Drive run = drive(frame, 100 + seed, 1.0, {10.0, kInfinity});
      const BlockId kept = *run.state.find("pose_3");
      std::size_t step = 0;  // the one at which it was kept
      double nearest = kInfinity;
      for (std::size_t k = 0; k < run.truth.size(); ++k) {
        const double d = (run.smoothed.poses[k] - run.state.estimate(kept)).norm();
        if (d < nearest) nearest = d, step = k;
      }
      ASSERT_LT(nearest, 1e-9);
      Eigen::Vector3d error = run.truth[step] - run.state.estimate(kept);
      error.z() = wrap_angle(error.z());
      const Eigen::Matrix3d cov = run.state.covariance_of(kept);
      nees += error.dot(cov.llt().solve(error));
    }
    EXPECT_GT(nees, chi_square_quantile(0.0005, 3 * kRuns)) << frame;
    EXPECT_LT(nees, chi_square_quantile(0.9995, 3 * kRuns)) << frame;
  }
}

TEST(DelayedPoses, RefuseWhatTheyCannotKeep) {
  EXPECT_THROW(DelayedPoses({0.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(DelayedPoses({1.0, std::nan("")}), std::invalid_argument);
}
