// One factor on Q, learned on a linear problem whose answer is known.

#include <cmath>
#include <random>
#include <tests/support/random_matrix.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/policy/process_scale.hpp>

using namespace libslam;
using libslam::testing::random_covariance;
using libslam::testing::random_matrix;

namespace {

BlockEvidence evidence(const Eigen::MatrixXd& h, const Eigen::MatrixXd& s,
                       const Eigen::VectorXd& nu) {
  const Eigen::MatrixXd inverse = s.inverse();
  return {h.transpose() * inverse * nu, h.transpose() * inverse * h};
}

}  // namespace

TEST(ProcessScale, RecursionByHand) {
  ProcessAdaptationParameters parameters;
  parameters.forgetting = 0.9;
  parameters.prior_weight = 2;
  ProcessScale policy(parameters, 0.95);
  BlockMatrix q1 = 2.0 * Eigen::MatrixXd::Ones(1, 1), q2 = Eigen::MatrixXd::Ones(1, 1);
  const BlockMatrix f = 3.0 * Eigen::MatrixXd::Ones(1, 1);
  policy.scale(f, q1);
  policy.scale(f, q2);
  const double q0 = 9.0 * 2.0 + 1.0, s = 30.0, nu = 8.0;
  policy.observe(evidence(Eigen::MatrixXd::Ones(1, 1), Eigen::MatrixXd::Constant(1, 1, s),
                          Eigen::VectorXd::Constant(1, nu)));
  const double d = 0.1 / (1.0 - 0.81);
  const double factor = 1.0 + d * (q0 * nu * nu / (s * s) / 0.95 - q0 / s);
  EXPECT_NEAR(policy.factor(), factor, 1e-13);
  EXPECT_NEAR(policy.noise().sigma, std::sqrt(factor), 1e-13);
  BlockMatrix q3 = Eigen::MatrixXd::Ones(1, 1);
  policy.scale(f, q3);
  EXPECT_NEAR(q3(0, 0), factor, 1e-13);
}

TEST(ProcessScale, LearnsNothingFromWhatIsSkipped) {
  ProcessScale policy({}, 1.0);
  BlockMatrix q = 100.0 * Eigen::MatrixXd::Ones(1, 1);
  policy.scale(Eigen::MatrixXd::Ones(1, 1), q);
  policy.skip();
  const Eigen::MatrixXd s = Eigen::MatrixXd::Ones(1, 1);
  policy.observe(evidence(s, s, 50.0 * Eigen::VectorXd::Ones(1)));
  EXPECT_EQ(policy.factor(), 1.0);
}

// A Kalman filter in the plane and heading whose Q is wrong by a factor; its Q has rank two in each
// step.
TEST(ProcessScale, FindsTheFactorOnALinearProblem) {
  for (const double truth : {4.0, 0.25}) {
    std::mt19937_64 random(71);
    ProcessAdaptationParameters parameters;
    ProcessScale policy(parameters, 1.0);
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), estimate = x;
    Eigen::Matrix3d p = 0.1 * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d r = 0.05 * Eigen::Matrix3d::Identity();
    double sum = 0.0;
    constexpr int kUpdates = 6000;
    for (int k = 0; k < kUpdates; ++k) {
      for (int step = 0; step < 2; ++step) {
        Eigen::MatrixXd g = random_matrix(3, 2, random);
        x += std::sqrt(truth) * g * random_matrix(2, 1, random);
        BlockMatrix q = g * g.transpose();
        policy.scale(Eigen::Matrix3d::Identity(), q);
        p += q;
      }
      const Eigen::Vector3d z = x + std::sqrt(0.05) * random_matrix(3, 1, random);
      const Eigen::Matrix3d s = p + r, gain = p * s.inverse();
      const Eigen::Vector3d nu = z - estimate;
      policy.observe(evidence(Eigen::Matrix3d::Identity(), s, nu));
      estimate += gain * nu;
      p -= gain * p;
      if (2 * k >= kUpdates) sum += policy.factor();
    }
    // Chi-square of three a time, 3000 times: 1.5 %; four of them.
    EXPECT_NEAR(sum / (kUpdates / 2) / truth, 1.0, 0.06);
  }
}

RC_GTEST_PROP(ProcessScaleProperty, StaysPositive, ()) {
  std::mt19937_64 random(*rc::gen::inRange(0u, 1'000'000u));
  ProcessAdaptationParameters parameters;
  parameters.forgetting = 0.6;
  parameters.prior_weight = 1.0;
  parameters.min_factor = 1e-6;
  parameters.max_factor = 1e6;
  ProcessScale policy(parameters, 1.0);
  double floor = 1.0;
  for (int k = 0; k < 20; ++k) {
    BlockMatrix q = random_covariance(3, random);
    policy.scale(Eigen::Matrix3d::Identity(), q);
    const Eigen::MatrixXd h = random_matrix(2, 3, random, 10.0);
    // A perfect sensor, and no surprise: the strongest pull downwards.
    const Eigen::MatrixXd s = h * q * h.transpose() + 1e-9 * Eigen::Matrix2d::Identity();
    policy.observe(evidence(h, s, Eigen::Vector2d::Zero()));
    const double d = 0.4 / (1.0 - std::pow(0.6, k + 1));
    // Two of three directions were seen to be still.
    floor *= 1.0 - d * 2.0 / 3.0;
    RC_ASSERT(policy.factor() > 0.999 * floor);
    RC_ASSERT(policy.factor() > 0.0);
  }
}
