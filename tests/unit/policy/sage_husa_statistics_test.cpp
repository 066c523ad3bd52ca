// What the noise estimator settles at, in mean and spread.

#include <cmath>
#include <random>
#include <tests/support/random_matrix.hpp>
#include <tests/unit/policy/noise_problem.hpp>
#include <vector>

#include <gtest/gtest.h>

#include <libslam/state/chi_square.hpp>

using namespace libslam;
using namespace libslam::test;
using libslam::testing::random_matrix;

namespace {

/// Measures a quantity known up to `predicted` again and again; noise of covariance `truth`, a gate
/// at `probability`. Returns R averaged over the last half of the updates.
Eigen::MatrixXd learned(const NoiseAdaptationParameters& parameters, const Eigen::MatrixXd& truth,
                        const Eigen::MatrixXd& start, const Eigen::MatrixXd& predicted,
                        double probability, int updates, unsigned seed, double kappa_gate) {
  std::mt19937_64 random(seed);
  const auto n = truth.rows();
  const Eigen::MatrixXd half = (truth + predicted).llt().matrixL();
  const double gate = chi_square_quantile(probability, static_cast<int>(n));
  SageHusa policy(parameters, components(static_cast<int>(n)), {kappa_gate, kappa_gate});
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (int k = 0; k < updates; ++k) {
    std::vector<Feature> features{feature_with(start)};
    policy.apply(features);
    const Eigen::MatrixXd r = features[0].cov;
    const Eigen::VectorXd nu = half * random_matrix(n, 1, random);
    if (nu.dot((predicted + r).ldlt().solve(nu)) <= gate) learn(policy, features, predicted, {nu});
    if (2 * k >= updates) sum += r;
  }
  return sum / (updates - (updates + 1) / 2);
}

}  // namespace

// d R = d (R/S)^2 (nu nu^T - S) near the fixed point: a scalar AR(1) whose mean over N updates has
// the relative standard deviation sqrt(2 / N) S / R, whatever the forgetting.
TEST(SageHusa, ConvergesToTheTrueCovarianceFromBothSides) {
  const Eigen::MatrixXd truth = (Eigen::MatrixXd(2, 2) << 0.5, 0.2, 0.2, 0.3).finished();
  const Eigen::MatrixXd predicted = 0.1 * Eigen::MatrixXd::Identity(2, 2);
  constexpr int kUpdates = 40000;
  for (const double wrong : {9.0, 1.0 / 9.0}) {
    const Eigen::MatrixXd r =
        learned(residual_form(), truth, wrong * truth, predicted, 1.0, kUpdates, 61, 1.0);
    // Four standard deviations of an entry, in units of the largest variance of nu.
    EXPECT_LT((r - truth).cwiseAbs().maxCoeff(), 4.0 * std::sqrt(2.0 / (kUpdates / 2)) * 0.6) << r;
  }
}

TEST(SageHusa, TheSpreadIsThatOfItsForgetting) {
  // A scalar measured against a known quantity: R is an exponential mean of squares, whose variance
  // is 2 R^2 (1 - b) / (1 + b).
  NoiseAdaptationParameters parameters = residual_form();
  parameters.forgetting = 0.95;
  std::mt19937_64 random(62);
  std::normal_distribution<double> normal;
  SageHusa policy(parameters, components(1), {});
  double sum = 0.0, squares = 0.0;
  constexpr int kUpdates = 60000;
  for (int k = 0; k < kUpdates; ++k) {
    std::vector<Feature> features{feature_with(Eigen::MatrixXd::Ones(1, 1))};
    policy.apply(features);
    const double r = features[0].cov(0, 0);
    learn(policy, features, Eigen::MatrixXd::Zero(1, 1),
          {Eigen::VectorXd::Constant(1, normal(random))});
    sum += r;
    squares += r * r;
  }
  const double mean = sum / kUpdates, variance = squares / kUpdates - mean * mean;
  EXPECT_NEAR(mean, 1.0, 4.0 * std::sqrt(2.0 / kUpdates));
  // Correlated over 1 / (1 - b) = 20 updates: 3000 independent values give 2.6 %, skewness some
  // more.
  EXPECT_NEAR(variance, 2.0 * 0.05 / 1.95, 0.15 * 2.0 * 0.05 / 1.95);
}

TEST(SageHusa, AGateIsAccountedFor) {
  const Eigen::MatrixXd truth = Eigen::Vector2d(0.5, 0.3).asDiagonal();
  const Eigen::MatrixXd predicted = 0.05 * Eigen::MatrixXd::Identity(2, 2);
  constexpr int kUpdates = 40000;
  const double tolerance = 4.0 * std::sqrt(2.0 / (kUpdates / 2)) * 0.55;
  for (const double probability : {0.9, 0.99}) {
    const Eigen::MatrixXd r = learned(residual_form(), truth, 4.0 * truth, predicted, probability,
                                      kUpdates, 63, probability);
    // What a gate lets through is less spread than kurtosis 3, but a shift of R moves the gate,
    // too, which amplifies the error of R by less than two at .9.
    EXPECT_LT((r - truth).cwiseAbs().maxCoeff(), 2.0 * tolerance) << probability << "\n" << r;
  }
  // Without the factor it settles far below.
  const Eigen::MatrixXd low =
      learned(residual_form(), truth, 4.0 * truth, predicted, 0.9, kUpdates, 63, 1.0);
  EXPECT_LT(low(0, 0), 0.5 - 4.0 * tolerance);
}

TEST(SageHusa, ABiasIsTakenOffTheMeasurements) {
  NoiseAdaptationParameters parameters = residual_form();
  parameters.bias = true;
  SageHusa policy(parameters, components(1), {});
  std::mt19937_64 random(65);
  std::normal_distribution<double> normal(0.5, 0.1);
  double z = 0.0, sum = 0.0;
  for (int k = 0; k < 4000; ++k) {
    std::vector<Feature> features{feature_with(Eigen::MatrixXd::Constant(1, 1, 0.01))};
    features[0].z[0] = normal(random);
    policy.apply(features);
    z = features[0].z[0];  // predicted: 0
    learn(policy, features, Eigen::MatrixXd::Zero(1, 1), {Eigen::VectorXd::Constant(1, z)});
    if (k >= 2000) sum += policy.bias(0)[0];
  }
  EXPECT_NEAR(sum / 2000, 0.5, 4.0 * 0.1 / std::sqrt(2000.0));
  EXPECT_NEAR(policy.noise()[0].sigma, 0.1, 0.1 * 0.5);  // spread of R 14 % at .98, four of them
}
