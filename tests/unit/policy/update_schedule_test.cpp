#include <stdexcept>

#include <gtest/gtest.h>

#include <libslam/policy/update_schedule.hpp>

using namespace libslam;

TEST(UpdateSchedule, PeriodIsTheShortestDistance) {
  UpdateSchedule schedule(1.0, 1);
  int due = 0;
  for (int k = 0; k <= 100; ++k) due += schedule.due(1e9 + 0.1 * k) ? 1 : 0;
  EXPECT_EQ(due, 11);  // at 0, 1, ..., 10 s
}

TEST(UpdateSchedule, EveryNthFrame) {
  UpdateSchedule schedule(0.0, 4);
  for (int k = 0; k < 12; ++k) EXPECT_EQ(schedule.due(5.0), k % 4 == 0) << k;
}

TEST(UpdateSchedule, WithoutPeriodEveryFrameIsDueEvenAtEqualTimes) {
  UpdateSchedule schedule(0.0, 1);
  for (int k = 0; k < 5; ++k) EXPECT_TRUE(schedule.due(0.0));
}

TEST(UpdateSchedule, RefusesNonsense) {
  EXPECT_THROW(UpdateSchedule(-1.0, 1), std::invalid_argument);
  EXPECT_THROW(UpdateSchedule(0.0, 0), std::invalid_argument);
}
