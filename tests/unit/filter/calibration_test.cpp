// Calibration as state: found where the motion excites it, left alone where it does not.

#include <cmath>
#include <limits>
#include <optional>
#include <tests/support/slam_world.hpp>

#include <gtest/gtest.h>

#include <libslam/association/known.hpp>
#include <libslam/data/step_events.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/measurement/range_bearing.hpp>
#include <libslam/motion/differential.hpp>

using namespace libslam;
using libslam::testing::SlamWorld;

namespace {

constexpr double kTrack = 0.5, kStep = 0.1;  // [m], [s]

EkfSlam make_filter(const SlamWorld& world, const CalibrationParameters& calibration,
                    std::optional<DisturbanceResponse> disturbance = {}) {
  MotionParameters motion;
  motion.track_width = kTrack;
  motion.noise = {};
  motion.noise.from_log = false;
  motion.noise.along_per_sqrt_m = motion.noise.across_per_sqrt_m = 0.0;
  motion.noise.turn_per_sqrt_m = motion.noise.turn_per_sqrt_rad = 0.0;
  motion.noise.along_per_sqrt_s = world.sigma_forward / std::sqrt(kStep);
  motion.noise.turn_per_sqrt_s = world.sigma_turn / std::sqrt(kStep);
  EkfSlamParts parts;
  parts.motion = std::make_unique<Differential>(motion, calibration);
  parts.measurement = std::make_unique<RangeBearing>();
  parts.associator = std::make_unique<KnownAssociation>(std::numeric_limits<double>::infinity());
  parts.frame = make_error_frame("right_invariant");
  parts.disturbance = std::move(disturbance);
  return EkfSlam(std::move(parts));
}

/// What wheels that are `left` and `right` times their nominal size would have reported.
void falsify(MotionAction& action, double left, double right) {
  const double half = 0.5 * action.increment[2];
  const double travel =
      action.increment.head<2>().norm() * (half == 0.0 ? 1.0 : half / std::sin(half));
  const double dl = (travel - half * kTrack) / left, dr = (travel + half * kTrack) / right;
  const double turn = (dr - dl) / kTrack, length = 0.5 * (dl + dr);
  const double chord = turn == 0.0 ? length : length * std::sin(0.5 * turn) / (0.5 * turn);
  action.increment = {chord * std::cos(0.5 * turn), chord * std::sin(0.5 * turn), turn};
}

}  // namespace

TEST(Calibration, WheelScalesAreFoundWithinTheirUncertainty) {
  CalibrationParameters calibration;
  calibration.scale_left.enabled = calibration.scale_right.enabled = true;
  constexpr double kLeft = 1.04, kRight = 0.97;
  for (unsigned seed = 81; seed < 86; ++seed) {
    std::mt19937_64 random(seed);
    SlamWorld world;
    EkfSlam filter = make_filter(world, calibration);
    for (int k = 0; k < 600; ++k) {
      MotionAction action = world.drive(random, 1.0);
      falsify(action, kLeft, kRight);
      filter.propagate(&action);
      filter.update(world.observe(random, 1.0));
    }
    const auto found = filter.calibration();
    ASSERT_EQ(found.size(), 2u);
    const double truth[] = {kLeft, kRight};
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_TRUE(found[i].observable) << found[i].name;
      EXPECT_LT(std::abs(found[i].mean - truth[i]), 4.0 * found[i].sigma) << found[i].name;
      EXPECT_LT(found[i].sigma, 0.01) << found[i].name;
    }
  }
}

// Straight ahead, the measured turn is noise alone. Regression of the true turn (zero) on it would
// pull 1 / track_width to zero and call it certain.
TEST(Calibration, TrackWidthKeepsItsPriorOnAStraightLine) {
  CalibrationParameters calibration;
  calibration.track_width.enabled = true;
  calibration.scale_left.enabled = calibration.scale_right.enabled = true;
  std::mt19937_64 random(91);
  SlamWorld world;
  world.step_turn = 0.0;
  world.landmarks.clear();
  for (int i = 0; i < 120; ++i) world.landmarks.emplace_back(2.5 * i, i % 2 == 0 ? 3.0 : -3.0);
  EkfSlam filter = make_filter(world, calibration);
  for (int k = 0; k < 500; ++k) {
    const MotionAction action = world.drive(random, 1.0);
    filter.propagate(&action);
    filter.update(world.observe(random, 1.0));
  }
  for (const CalibrationValue& value : filter.calibration()) {
    if (value.name == "track_width") {
      EXPECT_FALSE(value.observable);
      EXPECT_EQ(value.mean, value.prior_mean);
      EXPECT_DOUBLE_EQ(value.sigma, value.prior_sigma);
    } else {
      EXPECT_TRUE(value.observable) << value.name;
    }
  }
}

// A displacement that the wheels know nothing of is no lesson about the wheels.
TEST(Calibration, IsFrozenWhileADisturbanceLasts) {
  CalibrationParameters calibration;
  calibration.scale_left.enabled = calibration.scale_right.enabled = true;
  DisturbanceOptions options;
  options.sigma = Eigen::Vector3d(1.0, 1.0, 0.2);
  std::mt19937_64 random(87);
  SlamWorld world;
  EkfSlam filter =
      make_filter(world, calibration, DisturbanceResponse(Disturbance(options), ResponseOptions{}));
  std::string event;
  const auto step = [&] {
    MotionAction action = world.drive(random, 1.0);
    falsify(action, 1.0, 1.0);
    filter.propagate(&action);
    event = filter.update(world.observe(random, 1.0)).event;
    return filter.calibration();
  };
  std::vector<CalibrationValue> before;
  for (int k = 0; k < 100; ++k) before = step();
  world.pose[0] += 0.8;
  for (int k = 0; k < 4; ++k) {
    const auto now = step();
    EXPECT_EQ(has_event(event, "disturbance"), k == 0);
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_EQ(now[i].mean, before[i].mean);
      EXPECT_EQ(now[i].sigma, before[i].sigma);
    }
  }
  for (int k = 0; k < 20; ++k) step();
  EXPECT_NE(filter.calibration()[0].mean, before[0].mean);
}
