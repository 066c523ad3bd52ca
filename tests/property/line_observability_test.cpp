// A turn or a shift of the whole world changes no line that a robot sees, so no filter may gain
// information about them.

#include <limits>
#include <tests/support/room_world.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/association/known.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/measurement/line.hpp>
#include <libslam/motion/odometry_increment.hpp>

using namespace libslam;
using libslam::testing::RoomWorld;

namespace {

EkfSlam make_filter(const char* frame) {
  EkfSlamParts parts;
  CalibrationParameters calibration;
  calibration.scale_turn.enabled = calibration.bias_turn.enabled = true;
  parts.motion = std::make_unique<OdometryIncrement>(MotionParameters{}, calibration);
  parts.measurement = std::make_unique<LineMeasurement>();
  parts.associator = std::make_unique<KnownAssociation>(std::numeric_limits<double>::infinity());
  parts.frame = make_error_frame(frame);
  // The information along the world is that of the start: without any, P has no inverse.
  parts.cov_start = Eigen::Vector3d(0.1, 0.1, 0.1).cwiseAbs2().asDiagonal();
  return EkfSlam(std::move(parts));
}

/// N^T P^-1 N, N the directions along which shifts in x and y and a turn move the estimates.
Eigen::Matrix3d information_on_world(const EkfSlam& filter) {
  const GaussianState& state = filter.state();
  Eigen::MatrixX3d n = Eigen::MatrixX3d::Zero(state.dimension(), 3);
  for (const BlockId block : state.blocks()) {
    const Eigen::Index row = state.offset(block);
    const Eigen::VectorXd x = state.estimate(block);
    if (state.spec(block).role == WorldRole::kPose) {
      n.block<3, 3>(row, 0).setIdentity();
      n.block<2, 1>(row, 2) << -x[1], x[0];
    } else if (state.spec(block).role == WorldRole::kLine) {
      n(row, 2) = 1.0;
      n.block<1, 2>(row + 1, 0) << std::cos(x[0]), std::sin(x[0]);
    }
  }
  return n.transpose() * state.full_covariance().ldlt().solve(n);
}

/// Sums over the updates of a noisy drive of what each gains on shifts and on the turn, relative.
struct Gains {
  double shift = 0.0, turn = 0.0;
};

Gains gains_of_updates(const char* frame, unsigned seed, double sigma_turn) {
  std::mt19937_64 random(seed);
  RoomWorld world;
  world.sigma_turn = sigma_turn;
  EkfSlam filter = make_filter(frame);
  filter.update(world.observe(random, 1.0));
  Gains gains;
  for (int k = 0; k < 60; ++k) {
    const MotionAction action = world.drive(random, 1.0);
    filter.propagate(&action);
    const Eigen::Matrix3d before = information_on_world(filter);
    filter.update(world.observe(random, 1.0));
    const Eigen::Matrix3d gain = information_on_world(filter) - before;
    gains.turn += std::max(0.0, gain(2, 2)) / before(2, 2);
    gains.shift += std::max({0.0, gain(0, 0) / before(0, 0), gain(1, 1) / before(1, 1)});
  }
  return gains;
}

Gains drawn_gains(const char* frame) {
  const auto seed = *rc::gen::inRange(0u, 1'000'000u);
  const double sigma_turn = 0.01 * *rc::gen::inRange(3, 10);
  return gains_of_updates(frame, seed, sigma_turn);
}

// Rounding of the inverse of a covariance whose variances span seven decades, 60 times.
constexpr double kRounding = 1e-5;

}  // namespace

RC_GTEST_PROP(UnobservableWorldOfLines, IsKeptByTheInvariantFrame, ()) {
  const Gains gains = drawn_gains("right_invariant");
  RC_ASSERT(gains.turn < kRounding);
  RC_ASSERT(gains.shift < kRounding);
}

// The check can fail: the textbook filter gains information on shifts, because the normal of a
// line, along which they act on r, changes with the estimate.
RC_GTEST_PROP(UnobservableWorldOfLines, ShrinksInTheStandardFrame, ()) {
  const Gains gains = drawn_gains("standard");
  RC_ASSERT(gains.turn + gains.shift > 1e-3);
}
