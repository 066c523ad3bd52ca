#include <stdexcept>

#include <gtest/gtest.h>

#include <libslam/policy/update_schedule.hpp>

using namespace libslam;

namespace {

const Eigen::Vector3d kHere = Eigen::Vector3d::Zero();

PolicyParameters period(double seconds, int every_n = 1) {
  PolicyParameters p;
  p.update_period_s = seconds;
  p.update_every_n = every_n;
  return p;
}

PolicyParameters stretch(double seconds, double per_feature, const std::string& form) {
  PolicyParameters p = period(seconds);
  p.update_schedule.per_feature = per_feature;
  p.update_schedule.form = form;
  return p;
}

/// Updates of frames every `dt` [s] with as many features, robot at rest.
int updates(UpdateSchedule& schedule, int frames, double dt, int features) {
  int due = 0;
  for (int k = 0; k < frames; ++k) due += schedule.due(1e9 + dt * k, kHere, features) ? 1 : 0;
  return due;
}

}  // namespace

TEST(UpdateSchedule, PeriodIsTheShortestDistance) {
  UpdateSchedule schedule(period(1.0));
  EXPECT_EQ(updates(schedule, 101, 0.1, 3), 11);  // at 0, 1, ..., 10 s
  EXPECT_FALSE(schedule.savings());
}

TEST(UpdateSchedule, EveryNthFrame) {
  UpdateSchedule schedule(period(0.0, 4));
  for (int k = 0; k < 12; ++k) EXPECT_EQ(schedule.due(5.0, kHere, 1), k % 4 == 0) << k;
}

TEST(UpdateSchedule, WithoutPeriodEveryFrameIsDueEvenAtEqualTimes) {
  UpdateSchedule schedule(period(0.0));
  for (int k = 0; k < 5; ++k) EXPECT_TRUE(schedule.due(0.0, kHere, 1));
}

// T_s = 50 ms, frames every 10 ms: T = 50 (1 + 0.08 s) ms, rounded up to the frames.
TEST(UpdateSchedule, RelativeFormStretchesThePeriodByTheFeatures) {
  for (const auto& [features, frames_apart] :
       {std::pair(0, 5), std::pair(5, 7), std::pair(25, 15)}) {
    UpdateSchedule schedule(stretch(0.05, 0.08, "relative"));
    EXPECT_EQ(updates(schedule, 20 * frames_apart + 1, 0.01, features), 21) << features;
    ASSERT_TRUE(schedule.savings());
    EXPECT_EQ(schedule.savings()->updates, 21);
    EXPECT_EQ(schedule.savings()->without_stretch, 20 * frames_apart / 5 + 1);
  }
}

TEST(UpdateSchedule, AbsoluteFormAddsTimePerFeature) {
  UpdateSchedule schedule(stretch(0.05, 0.08, "absolute"));
  EXPECT_EQ(updates(schedule, 211, 0.01, 2), 11);  // 50 + 2 * 80 ms
  UpdateSchedule without_period(stretch(0.0, 0.08, "absolute"));
  EXPECT_EQ(updates(without_period, 161, 0.01, 2), 11);
}

// The figure of the source: 1832 instead of 2356 steps are 3.6 features on average.
TEST(UpdateSchedule, StepsOfTheSource) {
  UpdateSchedule schedule(stretch(0.05, 0.08, "relative"));
  constexpr double kFrame = 0.001;  // fine enough not to round T
  int due = 0;
  for (int k = 0; k < 117800; ++k)
    due += schedule.due(kFrame * k, kHere, due % 5 < 3 ? 4 : 3) ? 1 : 0;
  EXPECT_NEAR(due, 1832, 10);
  EXPECT_NEAR(static_cast<double>(schedule.savings()->without_stretch), 2356, 2);
}

TEST(UpdateSchedule, WayOrTurnSinceTheLastUpdate) {
  PolicyParameters p;
  p.update_schedule.distance = 0.2;
  p.update_schedule.turn_deg = 10.0;
  UpdateSchedule schedule(p);
  EXPECT_TRUE(schedule.due(0.0, {0, 0, 3.1}, 1));
  EXPECT_FALSE(schedule.due(1.0, {0.19, 0, 3.1}, 1));
  EXPECT_FALSE(schedule.due(2.0, {0.0, 0, -3.1}, 1));  // 4.8 degrees across pi
  EXPECT_TRUE(schedule.due(3.0, {0.0, 0, -3.0}, 1));
  EXPECT_TRUE(schedule.due(4.0, {0.0, 0.21, -3.0}, 1));
  p.update_schedule.turn_deg = 0.0;
  UpdateSchedule way_alone(p);
  EXPECT_TRUE(way_alone.due(0.0, kHere, 1));
  EXPECT_FALSE(way_alone.due(1.0, {0.0, 0.0, 2.0}, 1));
}

TEST(UpdateSchedule, ConditionsCompose) {
  PolicyParameters p = period(1.0, 2);
  p.update_schedule.distance = 0.5;
  UpdateSchedule schedule(p);
  std::vector<int> due;
  for (int k = 0; k < 40; ++k)  // 10 Hz, 0.2 m/s: the way takes 2.5 s, even frames alone count
    if (schedule.due(0.1 * k, {0.02 * k, 0.0, 0.0}, 1)) due.push_back(k);
  EXPECT_EQ(due, (std::vector<int>{0, 26}));
}

TEST(UpdateSchedule, SkippedFramesAreThoseThatAreNotDueAndCountAsSaved) {
  UpdateSchedule looked_at(stretch(0.1, 0.5, "relative")), skipped(stretch(0.1, 0.5, "relative"));
  for (int k = 0; k < 100; ++k) {
    const double time = 0.1 * k;
    const bool due = looked_at.due(time, kHere, 4);
    EXPECT_EQ(skipped.skip(time, kHere), !due) << k;
    if (due) EXPECT_TRUE(skipped.due(time, kHere, 4));
  }
  EXPECT_EQ(skipped.savings()->updates, looked_at.savings()->updates);
  EXPECT_EQ(skipped.savings()->without_stretch, looked_at.savings()->without_stretch);
  UpdateSchedule counting(period(1.0, 2));
  EXPECT_TRUE(counting.due(0.0, kHere, 1));
  EXPECT_FALSE(counting.skip(0.1, kHere));  // the frame has to be counted
}

TEST(UpdateSchedule, RefusesNonsense) {
  EXPECT_THROW(UpdateSchedule(period(-1.0)), std::invalid_argument);
  EXPECT_THROW(UpdateSchedule(period(0.0, 0)), std::invalid_argument);
  EXPECT_THROW(UpdateSchedule(stretch(1.0, -0.1, "relative")), std::invalid_argument);
}
