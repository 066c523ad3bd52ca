#include <gtest/gtest.h>

#include <libslam/frontend/odometry_check.hpp>

namespace libslam {
namespace {

using Relation = FieldCheck::Relation;

/// The verdict after as many readings as it takes, each followed by `standing` at standstill.
FieldVerdict judge(Relation relation, const Eigen::Vector2d& reading,
                   const Eigen::Vector2d& movement, const Eigen::Vector2d& standing) {
  FieldCheck check(relation, 0.2);
  EXPECT_EQ(check.verdict(), FieldVerdict::kAbsent);
  for (int i = 0; i < FieldCheck::kReadings; ++i) {
    EXPECT_NE(check.verdict(), FieldVerdict::kSane);
    check.observe(2 * i, standing, {0.0, 0.0});
    check.observe(2 * i + 1, reading, movement);
  }
  EXPECT_EQ(check.reason().empty(), check.verdict() == FieldVerdict::kSane);
  return check.verdict();
}

TEST(FieldCheck, ReadingsAtStandstillMustBeZero) {
  const Eigen::Vector2d moved(0.1, 0.02), still(0.0, 0.0), spinning(0.1, 0.02);
  EXPECT_EQ(judge(Relation::kEqual, moved, moved, still), FieldVerdict::kSane);
  EXPECT_EQ(judge(Relation::kEqual, moved, moved, spinning), FieldVerdict::kInsane);
  const Eigen::Vector2d ticks(100, 105);
  EXPECT_EQ(judge(Relation::kProportional, ticks, moved, still), FieldVerdict::kSane);
  EXPECT_EQ(judge(Relation::kProportional, ticks, moved, ticks), FieldVerdict::kInsane);
}

TEST(FieldCheck, NoiseOfTheTurnOnAStraightPathIsNoDisagreement) {
  const Eigen::Vector2d still(0.0, 0.0);
  EXPECT_EQ(judge(Relation::kEqual, {0.1, 0.0}, {0.1, 1.9e-3}, still), FieldVerdict::kSane);
  EXPECT_EQ(judge(Relation::kEqual, {0.1, 0.0}, {0.1, 2.1e-3}, still), FieldVerdict::kInsane);
}

TEST(FieldCheck, NoiseOfTheDistanceInATurnOnTheSpotIsNoDisagreement) {
  const Eigen::Vector2d still(0.0, 0.0);
  EXPECT_EQ(judge(Relation::kEqual, {0.0, 0.1}, {1.9e-3, 0.1}, still), FieldVerdict::kSane);
  EXPECT_EQ(judge(Relation::kEqual, {0.0, 0.1}, {2.1e-3, 0.1}, still), FieldVerdict::kInsane);
}

TEST(FieldCheck, AVerdictIsNotRevised) {
  FieldCheck check(Relation::kEqual, 0.2);
  check.condemn(3, "is nonsense");
  for (int i = 4; i < 100; ++i) check.observe(i, {0.1, 0.0}, {0.1, 0.0});
  EXPECT_EQ(check.verdict(), FieldVerdict::kInsane);
  check.condemn(200, "again");
  EXPECT_EQ(check.reason(), "step 3: is nonsense");
}

TEST(FieldCheck, TicksOfImplausibleSizeAreInsane) {
  // Constant garbage fits a constant speed, at 0.05 nm per tick.
  const Eigen::Vector2d still(0.0, 0.0);
  EXPECT_EQ(judge(Relation::kProportional, {2117699626, 2117699626}, {0.1, 0.0}, still),
            FieldVerdict::kInsane);
  EXPECT_EQ(judge(Relation::kProportional, {10, 10}, {0.1, 0.0}, still), FieldVerdict::kSane);
}

}  // namespace
}  // namespace libslam
