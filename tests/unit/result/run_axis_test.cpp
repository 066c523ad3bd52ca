#include <gtest/gtest.h>

#include <libslam/result/run_axis.hpp>

namespace libslam {
namespace {

std::vector<EstimatedPose> path_at(const std::vector<double>& times) {
  std::vector<EstimatedPose> path;
  for (const double time : times)
    path.push_back({.step = 3 * static_cast<std::int64_t>(path.size()), .time = time});
  return path;
}

TEST(RunAxis, TimeSinceTheFirstStep) {
  const auto path = path_at({100, 101, 103});
  const RunAxis axis(path);
  EXPECT_TRUE(axis.is_time());
  EXPECT_EQ(axis.at(path[2]), 3.0);
  EXPECT_EQ(axis.at_step(6), 3.0);
  EXPECT_EQ(axis.at_step(5), 1.0);  // the row before: rows may be thinned
  EXPECT_EQ(axis.at_step(99), 3.0);
  EXPECT_EQ(axis.at_step(-1), 0.0);
}

TEST(RunAxis, StepsWhereTimesAreUseless) {
  const auto path = path_at({100, 100, 100, 100.004, 100.004});
  const RunAxis axis(path);
  EXPECT_FALSE(axis.is_time());
  EXPECT_EQ(axis.at(path[4]), 12.0);
  EXPECT_EQ(axis.at_step(7), 7.0);
}

TEST(RunAxis, AFewRepeatedTimesDoNotMatter) {
  std::vector<double> times;
  for (int i = 0; i < 100; ++i) times.push_back(i - (i % 20 == 7));
  EXPECT_TRUE(RunAxis(path_at(times)).is_time());
}

TEST(RunAxis, AnEmptyRunHasAnAxis) {
  EXPECT_FALSE(RunAxis({}).is_time());
}

}  // namespace
}  // namespace libslam
