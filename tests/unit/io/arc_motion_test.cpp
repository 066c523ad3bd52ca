#include <cmath>

#include <gtest/gtest.h>
#include <mrpt/poses/CPose2D.h>

#include <libslam/io/arc_motion.hpp>

namespace libslam {
namespace {

using mrpt::poses::CPose2D;

CPose2D pose(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

// Rounding of a handful of operations on numbers of order 1.
constexpr double kRounding = 1e-13;

class ArcMotion : public testing::TestWithParam<double> {};

TEST_P(ArcMotion, IncrementAndArcAreInverse) {
  const Eigen::Vector3d arc(1.3, -0.4, GetParam());
  EXPECT_LT((arc_of_increment(increment_of_arc(arc)) - arc).norm(), kRounding);
}

TEST_P(ArcMotion, PartsComposeToTheWhole) {
  const Eigen::Vector3d whole(0.7, 0.2, GetParam());
  CPose2D sum;
  for (const double part : {0.1, 0.35, 0.0, 0.55}) sum = sum + pose(part_of_motion(whole, part));
  EXPECT_NEAR(sum.x(), whole.x(), kRounding);
  EXPECT_NEAR(sum.y(), whole.y(), kRounding);
  EXPECT_NEAR(std::remainder(sum.phi() - whole.z(), 2.0 * M_PI), 0.0, kRounding);
}

INSTANTIATE_TEST_SUITE_P(Turns, ArcMotion,
                         testing::Values(0.0, 1e-12, -1e-8, 9.9e-5, 1.01e-4, 2.1e-4, -0.3, 1.0,
                                         -2.0, 3.14159));

TEST(ArcMotionCircle, QuarterTurnEndsOnTheCircle) {
  const Eigen::Vector3d end = increment_of_arc({M_PI / 2, 0.0, M_PI / 2});
  EXPECT_NEAR(end.x(), 1.0, kRounding);
  EXPECT_NEAR(end.y(), 1.0, kRounding);
}

}  // namespace
}  // namespace libslam
