#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <libslam/policy/implied_input.hpp>

using namespace libslam;

namespace {

/// A robot on a line with error variance `p`, that sees a landmark with variance `r` twice over.
JointInnovation line_innovation(double p, double r, double nu) {
  JointInnovation joint;
  joint.nu = Eigen::Vector2d(nu, nu);
  joint.wrt_pose = Eigen::MatrixXd::Constant(2, 1, -1.0);
  joint.cov = Eigen::Matrix2d::Constant(p) + r * Eigen::Matrix2d::Identity();
  return joint;
}

}  // namespace

// With one input, w = Q g and q = g^2 Q: the mean of both sightings against p + r / 2.
TEST(ImpliedInput, SquaredMotionOnALine) {
  ImpliedInput policy(0.999);
  policy.move(BlockMatrix::Identity(1, 1), BlockMatrix::Constant(1, 1, 0.25));
  const double g = 3.0 / (1.0 + 0.5 * 0.2);
  EXPECT_NEAR(policy.squared_motion(line_innovation(1.0, 0.2, 3.0)), g * g * 0.25, 1e-12);
}

TEST(ImpliedInput, NoiseAccumulatesThroughTheMotionUntilTheRestart) {
  ImpliedInput policy(0.999);
  const JointInnovation joint = line_innovation(10.0, 0.1, 5.0);
  EXPECT_EQ(policy.squared_motion(joint), 0.0);  // nothing has moved
  policy.move(BlockMatrix::Identity(1, 1), BlockMatrix::Constant(1, 1, 1.0));
  const double once = policy.squared_motion(joint);
  policy.move(BlockMatrix::Constant(1, 1, 2.0), BlockMatrix::Constant(1, 1, 1.0));
  EXPECT_NEAR(policy.squared_motion(joint), 5.0 * once, 1e-9 * once);
  policy.restart();
  EXPECT_EQ(policy.squared_motion(joint), 0.0);
  EXPECT_FALSE(policy.impossible(joint));
}

// A tracker that froze on a robot with well known odometry and a map as uncertain as its pose.
TEST(ImpliedInput, FindsATrackerThatFroze) {
  ImpliedInput policy(0.999);
  policy.move(BlockMatrix::Identity(1, 1), BlockMatrix::Constant(1, 1, 0.01));
  // S is the noise of the motion and of the pixels: pose and map are uncertain together.
  const JointInnovation frozen = line_innovation(0.01, 1e-4, 0.6);
  EXPECT_TRUE(policy.impossible(frozen));
  EXPECT_FALSE(policy.impossible(line_innovation(0.01, 1e-4, 0.2)));
}

// While the filter is right q is at most chi-square: its exceedance is no more than the rest of the
// probability. 20000 draws: 0.01 within five standard deviations of 0.0007.
TEST(ImpliedInput, RarelyFalseWhileTheFilterIsRight) {
  constexpr int kDraws = 20000;
  constexpr double kProbability = 0.99;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  ImpliedInput policy(kProbability);
  policy.move(BlockMatrix::Identity(1, 1), BlockMatrix::Constant(1, 1, 0.5));
  int exceeded = 0;
  for (int i = 0; i < kDraws; ++i) {
    JointInnovation joint = line_innovation(0.5, 0.01, 0.0);
    const double pose = std::sqrt(0.5) * normal(random);
    joint.nu = Eigen::Vector2d(pose + 0.1 * normal(random), pose + 0.1 * normal(random));
    exceeded += policy.impossible(joint) ? 1 : 0;
  }
  EXPECT_LE(exceeded / static_cast<double>(kDraws), 1.0 - kProbability + 5 * 0.0007);
  EXPECT_GT(exceeded, 0);
}

TEST(ImpliedInput, RefusesAProbabilityThatIsNone) {
  for (const double probability : {0.0, 1.0, -0.1, std::nan("")})
    EXPECT_THROW(ImpliedInput{probability}, std::invalid_argument);
}
