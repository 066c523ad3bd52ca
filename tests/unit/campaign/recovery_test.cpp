#include <initializer_list>

#include <gtest/gtest.h>

#include <libslam/campaign/recovery.hpp>

using namespace libslam;

namespace {

KidnapParameters at_ten_seconds() {
  KidnapParameters kidnap;
  kidnap.enabled = true;
  kidnap.time_s = 10.0;
  return kidnap;
}

/// One update per 0.2 s with an error of `before`, then those of `after`.
nlohmann::ordered_json judge(const KidnapParameters& kidnap, int updates, double before,
                             std::initializer_list<double> after) {
  Recovery recovery(kidnap);
  for (int k = 0; k < updates; ++k) recovery.observe(10.0 - 0.2 * (updates - k), before);
  double time = 10.0;
  for (const double error : after) {
    recovery.observe(time, error);
    time += 0.2;
  }
  return recovery.figures();
}

}  // namespace

TEST(Recovery, CountsUpdatesUntilTwiceTheErrorBefore) {
  const auto figures = judge(at_ten_seconds(), 30, 0.5, {3.0, 2.0, 1.01, 0.9, 4.0});
  EXPECT_EQ(figures["updates"], 4);
  EXPECT_EQ(figures["never"], 0);
}

TEST(Recovery, SaysNever) {
  const auto figures = judge(at_ten_seconds(), 30, 0.5, {3.0, 2.0, 1.01});
  EXPECT_EQ(figures["never"], 1);
  EXPECT_FALSE(figures.contains("updates"));
}

TEST(Recovery, JudgesNothingWithoutAKidnapOrALevel) {
  EXPECT_TRUE(judge({}, 30, 0.5, {0.1}).is_null());
  EXPECT_TRUE(judge(at_ten_seconds(), 24, 0.5, {0.1}).is_null());
  EXPECT_TRUE(judge(at_ten_seconds(), 30, 0.5, {}).is_null());
}
