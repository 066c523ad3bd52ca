#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/io/observation_splitter.hpp>

#include "log_builder.hpp"

namespace libslam {
namespace {

using test::motion_of;

mrpt::obs::CObservation::Ptr seen(double time) {
  return std::make_shared<mrpt::obs::CObservationBearingRange>(test::sighting(time));
}

OdometryReading reading(double time, const Eigen::Vector3d& pose) {
  OdometryReading r;
  r.time = time;
  r.pose = pose;
  return r;
}

std::vector<LogStep> drain(ObservationSplitter& splitter) {
  splitter.finish();
  return {splitter.ready().begin(), splitter.ready().end()};
}

/// Doubles in [0, 1) on a grid, so that equal times occur.
rc::Gen<double> fraction() {
  return rc::gen::map(rc::gen::inRange(0, 64), [](int i) { return i / 64.0; });
}

RC_GTEST_PROP(ObservationSplitter, IncrementsComposeToTheAbsolutePoses, ()) {
  const auto turns = *rc::gen::container<std::vector<double>>(6, fraction());
  const auto times = *rc::gen::container<std::vector<double>>(20, fraction());
  ObservationSplitter splitter;
  Eigen::Vector3d first = Eigen::Vector3d::Zero(), last = first;
  std::size_t next = 0;
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const double t = static_cast<double>(k);
    last = {std::sin(3.0 * t), turns[k], 6.0 * turns[k] - 3.0};
    if (k == 0) first = last;
    splitter.add_reading(reading(t, last));
    for (int i = 0; i < 3 && next < times.size(); ++i, ++next) {
      const double at = t + times[next];
      splitter.add_observation(seen(at), at, 1);
    }
  }
  mrpt::poses::CPose2D sum(first.x(), first.y(), first.z());
  double time = -std::numeric_limits<double>::infinity(), moved = 0.0;
  std::size_t observations = 0;
  for (const LogStep& step : drain(splitter)) {
    RC_ASSERT(step.time >= time);
    time = step.time;
    if (const auto motion = motion_of(step)) sum = sum + motion->rawOdometryIncrementReading;
    moved += step.dt;
    if (step.frame) observations += step.frame->size();
  }
  // Rounding of 26 compositions of poses of order 1.
  RC_ASSERT(std::abs(sum.x() - last.x()) < 1e-12);
  RC_ASSERT(std::abs(sum.y() - last.y()) < 1e-12);
  RC_ASSERT(std::abs(std::remainder(sum.phi() - last.z(), 2.0 * M_PI)) < 1e-12);
  RC_ASSERT(std::abs(moved - static_cast<double>(turns.size() - 1)) < 1e-12);
  RC_ASSERT(observations == next);
}

TEST(ObservationSplitter, CutsInProportionToTimeAlongTheArc) {
  ObservationSplitter splitter;
  splitter.add_reading(reading(10.0, {0.0, 0.0, 0.0}));
  splitter.add_observation(seen(11.0), 11.0, 1);
  splitter.add_reading(reading(14.0, {1.0, 1.0, M_PI / 2}));  // a quarter of the unit circle
  const auto steps = drain(splitter);
  ASSERT_EQ(steps.size(), 2U);
  const auto& part = motion_of(steps[0])->rawOdometryIncrementReading;
  EXPECT_NEAR(part.x(), std::sin(M_PI / 8), 1e-14);
  EXPECT_NEAR(part.y(), 1.0 - std::cos(M_PI / 8), 1e-14);
  EXPECT_NEAR(part.phi(), M_PI / 8, 1e-14);
  EXPECT_DOUBLE_EQ(steps[0].dt, 1.0);
  EXPECT_DOUBLE_EQ(steps[1].dt, 3.0);
  EXPECT_TRUE(steps[0].frame);
  EXPECT_FALSE(steps[1].frame);
  EXPECT_FALSE(steps[0].has_motion_covariance);
}

TEST(ObservationSplitter, AllPartsCarryTheVelocityOfTheInterval) {
  ObservationSplitter splitter;
  splitter.add_reading(reading(0.0, Eigen::Vector3d::Zero()));
  splitter.add_observation(seen(0.25), 0.25, 1);
  OdometryReading last = reading(1.0, {0.5, 0.0, 0.0});
  last.velocity = Eigen::Vector3d(0.5, 0.0, 0.1);
  splitter.add_reading(last);
  for (const LogStep& step : drain(splitter)) {
    EXPECT_TRUE(motion_of(step)->hasVelocities);
    EXPECT_EQ(motion_of(step)->velocityLocal.vx, 0.5);
    EXPECT_EQ(motion_of(step)->velocityLocal.omega, 0.1);
  }
}

TEST(ObservationSplitter, TicksSumExactlyAcrossTheOverflowOfTheCounter) {
  ObservationSplitter splitter;
  OdometryReading a = reading(0.0, Eigen::Vector3d::Zero()), b = reading(1.0, {0.1, 0.0, 0.0});
  a.ticks = {INT32_MAX - 4, INT32_MIN + 2};
  b.ticks = {INT32_MIN + 5, INT32_MAX - 7};  // +10 and -10
  splitter.add_reading(a);
  for (const double t : {0.26, 0.5, 0.77}) splitter.add_observation(seen(t), t, 1);
  splitter.add_reading(b);
  int left = 0, right = 0;
  for (const LogStep& step : drain(splitter)) {
    const auto motion = motion_of(step);
    ASSERT_TRUE(motion->hasEncodersInfo);
    left += motion->encoderLeftTicks;
    right += motion->encoderRightTicks;
    EXPECT_LE(std::abs(left - 10.0 * step.time), 0.5);
    EXPECT_LE(std::abs(right + 10.0 * step.time), 0.5);
  }
  EXPECT_EQ(left, 10);
  EXPECT_EQ(right, -10);
}

TEST(ObservationSplitter, NoTicksWhereOneReadingHasNone) {
  ObservationSplitter splitter;
  OdometryReading a = reading(0.0, Eigen::Vector3d::Zero());
  a.ticks = {1, 1};
  splitter.add_reading(a);
  splitter.add_reading(reading(1.0, {0.1, 0.0, 0.0}));
  const auto steps = drain(splitter);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_FALSE(motion_of(steps[0])->hasEncodersInfo);
}

TEST(ObservationSplitter, ObservationAtTheTimeOfAReadingSharesItsStep) {
  ObservationSplitter splitter;
  splitter.add_reading(reading(0.0, Eigen::Vector3d::Zero()));
  splitter.add_reading(reading(1.0, {1.0, 0.0, 0.0}));
  splitter.add_observation(seen(1.0), 1.0, 1);
  splitter.add_observation(seen(1.0), 1.0, 1);
  const auto steps = drain(splitter);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_TRUE(steps[0].action);
  EXPECT_EQ(steps[0].frame->size(), 2U);
}

TEST(ObservationSplitter, NoMotionBeforeTheFirstAndAfterTheLastReading) {
  ObservationSplitter splitter;
  splitter.add_observation(seen(0.5), 0.5, 1);
  splitter.add_reading(reading(1.0, Eigen::Vector3d::Zero()));
  splitter.add_reading(reading(2.0, {1.0, 0.0, 0.0}));
  splitter.add_observation(seen(2.5), 2.5, 1);
  const auto steps = drain(splitter);
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_FALSE(steps[0].action);
  EXPECT_TRUE(steps[1].action);
  EXPECT_FALSE(steps[2].action);
  EXPECT_EQ(steps[2].time, 2.5);
}

TEST(ObservationSplitter, AnObservationMayStandOneReadingLate) {
  ObservationSplitter splitter;
  splitter.add_reading(reading(0.0, Eigen::Vector3d::Zero()));
  splitter.add_reading(reading(1.0, {1.0, 0.0, 0.0}));
  splitter.add_observation(seen(0.5), 0.5, 1);
  splitter.add_reading(reading(2.0, {2.0, 0.0, 0.0}));
  const auto steps = drain(splitter);
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_TRUE(steps[0].frame);
  EXPECT_NEAR(motion_of(steps[0])->rawOdometryIncrementReading.x(), 0.5, 1e-15);
  EXPECT_EQ(splitter.open_time(), 2.0);
}

TEST(ObservationSplitter, OdometryThatStopsDoesNotFillTheMemory) {
  ObservationSplitter splitter(1000);
  splitter.add_reading(reading(0.0, Eigen::Vector3d::Zero()));
  for (int i = 1; i <= 100; ++i) splitter.add_observation(seen(i), i, 100);
  EXPECT_GE(splitter.ready().size(), 90U);
  splitter.add_reading(reading(200.0, {3.0, 0.0, 0.0}));
  double moved = 0.0;
  for (const LogStep& step : drain(splitter))
    if (const auto motion = motion_of(step)) moved += motion->rawOdometryIncrementReading.x();
  EXPECT_NEAR(moved, 3.0, 1e-12);
}

}  // namespace
}  // namespace libslam
