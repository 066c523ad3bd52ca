#include <random>

#include <gtest/gtest.h>

#include <libslam/policy/excitation.hpp>

using namespace libslam;

namespace {

constexpr double kStep = 0.1;    // [s]
constexpr double kSigma = 0.02;  // odometry noise per step, forward and turn

/// A drive that moves `forward` and turns `turn` per step, both measured with noise; parameter 0
/// scales the forward motion, parameter 1 the turn. Returns the steps at which the turn counted as
/// excited.
int excited_steps(double forward, double turn, unsigned seed, int steps, int* forward_steps) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, kSigma);
  Excitation excitation({1.0, 1.0});
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
  noise(0, 0) = noise(2, 2) = kSigma * kSigma;
  int count = 0;
  for (int k = 0; k < steps; ++k) {
    Eigen::Matrix3Xd jacobian = Eigen::Matrix3Xd::Zero(3, 2);
    jacobian(0, 0) = forward + normal(random);
    jacobian(2, 1) = turn + normal(random);
    excitation.observe(jacobian, noise, kStep);
    count += excitation.excited(1) ? 1 : 0;
    *forward_steps += excitation.excited(0) ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST(Excitation, NoiseAloneDoesNotExcite) {
  // Mean of windows of chi-square(1), effective number of windows (1 + b) / (1 - b) = 39, so its
  // standard deviation is 0.23: the threshold 4 is 13 of them above the mean.
  int turn_excited = 0, forward_excited = 0;
  for (unsigned seed = 1; seed <= 20; ++seed)
    turn_excited += excited_steps(0.1, 0.0, seed, 3000, &forward_excited);
  EXPECT_EQ(turn_excited, 0);
  EXPECT_GT(forward_excited, 20 * 2900);
}

TEST(Excitation, ATurnOfSeveralSigmaExcites) {
  int unused = 0;
  // Per window of 1 s: (10 * 0.05)^2 / (10 * 0.02^2) = 62.
  EXPECT_GT(excited_steps(0.0, 0.05, 3, 1000, &unused), 950);
}

TEST(Excitation, StandingStillEndsIt) {
  Excitation excitation({1.0});
  const Eigen::Matrix3d noise = 1e-4 * Eigen::Matrix3d::Identity();
  Eigen::Matrix3Xd jacobian = Eigen::Matrix3Xd::Zero(3, 1);
  jacobian(0, 0) = 1.0;
  for (int k = 0; k < 50; ++k) excitation.observe(jacobian, noise, 1.0);
  EXPECT_TRUE(excitation.excited(0));
  jacobian.setZero();
  for (int k = 0; k < 400; ++k) excitation.observe(jacobian, noise, 1.0);
  EXPECT_FALSE(excitation.excited(0));
}

TEST(Excitation, GoesOnFromItsMemory) {
  const auto observe = [](Excitation& excitation, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Eigen::Matrix3Xd jacobian(3, 2);
    for (double& value : jacobian.reshaped()) value = normal(random);
    excitation.observe(jacobian, 0.1 * Eigen::Matrix3d::Identity(), 0.3);
  };
  Excitation whole({1.0, 2.0}), later({1.0, 2.0});
  for (std::uint64_t k = 0; k < 50; ++k) observe(whole, k);
  later.remember(whole.memory());
  for (std::uint64_t k = 50; k < 120; ++k) {
    observe(whole, k);
    observe(later, k);
    ASSERT_EQ(later.memory(), whole.memory());
  }
  EXPECT_TRUE(later.ever_excited(1));
  EXPECT_THROW(Excitation({1.0}).remember(whole.memory()), std::invalid_argument);
}
