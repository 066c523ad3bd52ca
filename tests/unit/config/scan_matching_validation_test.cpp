// Combinations of scan matching with the rest of a configuration.

#include <functional>

#include <gtest/gtest.h>

#include <libslam/config/validation.hpp>

namespace libslam {
namespace {

using Keys = std::vector<std::string>;

Keys first_conflict(const std::function<void(Parameters&)>& change) {
  Parameters p;
  p.input.scan_matching.enabled = true;
  change(p);
  const auto conflicts = find_conflicts(p);
  return conflicts.empty() ? Keys{} : conflicts.front().keys;
}

TEST(ScanMatchingValidation, IncrementsAreMatched) {
  EXPECT_EQ(first_conflict([](Parameters&) {}), Keys{});
  EXPECT_EQ(first_conflict([](Parameters& p) { p.input.odometry = "increments"; }), Keys{});
  for (const char* source : {"velocities", "ticks", "twist", "none"})
    EXPECT_EQ(first_conflict([&](Parameters& p) { p.input.odometry = source; }),
              (Keys{"input.scan_matching.enabled", "input.odometry"}))
        << source;
}

TEST(ScanMatchingValidation, OnlyIncrementsThatMayGoSideways) {
  const Keys keys{"input.scan_matching.enabled", "motion.model", "motion.increment_form"};
  EXPECT_EQ(first_conflict([](Parameters& p) { p.motion.model = "differential"; }), keys);
  EXPECT_EQ(first_conflict([](Parameters& p) { p.motion.increment_form = "arc"; }), keys);
}

}  // namespace
}  // namespace libslam
