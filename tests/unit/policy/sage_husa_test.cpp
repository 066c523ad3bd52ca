// The noise estimator step by step: its recursion, its rounds, its definiteness.

#include <algorithm>
#include <cmath>
#include <random>
#include <tests/support/random_matrix.hpp>
#include <tests/unit/policy/noise_problem.hpp>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

using namespace libslam;
using namespace libslam::test;
using libslam::testing::random_covariance;
using libslam::testing::random_matrix;

TEST(SageHusa, ScalarRecursionByHand) {
  NoiseAdaptationParameters parameters = residual_form();
  parameters.forgetting = 0.9;
  parameters.prior_weight = 3;
  SageHusa policy(parameters, components(1), {});
  double r = 4.0, weight = 3.0;
  const double predicted = 1.5;
  const double innovations[] = {2.3, -3.0, 0.2, 7.0};
  int most = 0, fewest = 9;
  for (int k = 0; k < 4; ++k) {
    std::vector<Feature> features{feature_with(Eigen::MatrixXd::Constant(1, 1, 4.0))};
    policy.apply(features);
    ASSERT_NEAR(features[0].cov(0, 0), r, 1e-13);
    const int taken = learn(policy, features, Eigen::MatrixXd::Constant(1, 1, predicted),
                            {Eigen::VectorXd::Constant(1, innovations[k])});
    weight = 0.9 * weight + 1.0;
    const double d = 1.0 / weight, before = r;
    double weighed_with = 0.0;
    int rounds = 0;
    do {
      weighed_with = r;
      const double s = predicted + r, e = r / s * innovations[k], c = r - r * r / s;
      r = (1.0 - d) * before + d * (e * e + c);
      ++rounds;
    } while (std::abs(r / weighed_with - 1.0) > 0.1);
    EXPECT_EQ(taken, rounds) << k;
    most = std::max(most, taken);
    fewest = std::min(fewest, taken);
  }
  EXPECT_EQ(fewest, 1);
  EXPECT_GT(most, 2);
  EXPECT_NEAR(policy.noise()[0].sigma, std::sqrt(r), 1e-13);
  EXPECT_NEAR(policy.noise()[0].configured, 2.0, 1e-13);
}

TEST(SageHusa, ClassicRecursionByHandAndItsRepair) {
  NoiseAdaptationParameters parameters = residual_form();
  parameters.method = "classic";
  parameters.forgetting = 0.5;
  parameters.prior_weight = 1;
  for (const double floor : {0.0, 0.25}) {
    parameters.eigenvalue_floor = floor;
    SageHusa policy(parameters, components(1), {});
    std::vector<Feature> features{feature_with(Eigen::MatrixXd::Constant(1, 1, 4.0))};
    policy.apply(features);
    const Eigen::MatrixXd predicted = Eigen::MatrixXd::Constant(1, 1, 9.0);
    EXPECT_EQ(learn(policy, features, predicted, {Eigen::VectorXd::Constant(1, 1.0)}), 1);
    features = {feature_with(Eigen::MatrixXd::Constant(1, 1, 4.0))};
    policy.apply(features);
    // W = 1.5: a third of 4 and two thirds of nu^2 - H P- H^T = -8: not a variance, unless it is
    // repaired.
    EXPECT_NEAR(features[0].cov(0, 0), floor > 0.0 ? 1.0 : -4.0, 1e-13);
  }
}

// From a ninth of the variance: twenty measurements at once against a prior that counts for twenty.
TEST(SageHusa, TheFirstObservationIsWeighedWithWhatItShows) {
  std::mt19937_64 random(66);
  const Eigen::MatrixXd truth = Eigen::Vector2d(0.9, 0.9).asDiagonal();
  const Eigen::MatrixXd predicted = 0.01 * Eigen::MatrixXd::Identity(2, 2);
  SageHusa policy(residual_form(), components(2), {});
  std::vector<Feature> features(20, feature_with(truth / 9.0));
  policy.apply(features);
  std::vector<Eigen::VectorXd> nu;
  for (int i = 0; i < 20; ++i) nu.push_back(std::sqrt(0.91) * random_matrix(2, 1, random));
  EXPECT_GT(learn(policy, features, predicted, nu), 1);
  // (.98 * 20 * .1 + 20 * .9) / (.98 * 20 + 20) = .504 expected; the mean of 40 squares has a
  // relative standard deviation of sqrt(2 / 40) = .22, four of them on the part of the data.
  const double mean = features[0].cov.trace() / 2.0;
  EXPECT_NEAR(mean, 0.504, 4.0 * 0.22 * 0.9 * 20.0 / 39.6);
  // What the features were weighed with last is what is believed, but for what was not worth it.
  std::vector<Feature> next(1, feature_with(truth / 9.0));
  policy.apply(next);
  EXPECT_LT((next[0].cov - features[0].cov).diagonal().cwiseAbs().maxCoeff(),
            0.1 * features[0].cov.diagonal().maxCoeff());
}

TEST(SageHusa, EveryMeasurementCountsTheSame) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  NoiseAdaptationParameters parameters = residual_form();
  parameters.forgetting = 0.99999;
  SageHusa together(parameters, components(1), {}), apart(parameters, components(1), {});
  std::vector<Feature> features(10, feature_with(one));
  together.apply(features);
  // Known exactly: what a measurement says does not depend on R.
  const Eigen::MatrixXd known = Eigen::MatrixXd::Zero(1, 1);
  learn(together, features, known,
        std::vector<Eigen::VectorXd>(10, Eigen::VectorXd::Constant(1, 2)));
  for (int k = 0; k < 10; ++k) {
    features.assign(1, feature_with(one));
    apart.apply(features);
    learn(apart, features, known, {Eigen::VectorXd::Constant(1, 2)});
  }
  // (20 + 10 * 4) / 30; ten times forgotten 1e-5 of a weight of 20 or more.
  EXPECT_NEAR(together.factor(0)(0, 0), 2.0, 1e-4);
  EXPECT_NEAR(apart.factor(0)(0, 0), 2.0, 1e-3);
}

RC_GTEST_PROP(SageHusaProperty, TheResidualFormStaysPositiveDefinite, ()) {
  const int n = *rc::gen::inRange(1, 4);
  std::mt19937_64 random(*rc::gen::inRange(0u, 1'000'000u));
  NoiseAdaptationParameters parameters = residual_form();
  parameters.forgetting = *rc::gen::element(0.6, 0.98, 0.999);
  parameters.prior_weight = *rc::gen::element(1.0, 20.0);
  SageHusa policy(parameters, components(n, 1e-12, 1e12), {0.99, 0.99});
  const Eigen::MatrixXd start = random_covariance(n, random);
  for (int k = 0; k < 300; ++k) {
    std::vector<Feature> features{feature_with(start)};
    policy.apply(features);
    const Eigen::MatrixXd r = features[0].cov;
    RC_ASSERT(r.isApprox(r.transpose(), 1e-12));
    RC_ASSERT(Eigen::LLT<Eigen::MatrixXd>(r).info() == Eigen::Success);
    // Nonsense of any size, also no surprise at all, and a prediction of any quality.
    const double scale = std::pow(10.0, *rc::gen::inRange(-4, 4));
    const double surprise = *rc::gen::element(0.0, 1e-3, 1.0, 1e3);
    const Eigen::MatrixXd predicted = random_covariance(n, random, scale);
    learn(policy, features, predicted, {random_matrix(n, 1, random, surprise)});
    RC_ASSERT(Eigen::LLT<Eigen::MatrixXd>(features[0].cov).info() == Eigen::Success);
  }
}

TEST(SageHusa, RefusesWhatItCannotUse) {
  NoiseAdaptationParameters parameters = residual_form();
  EXPECT_THROW(SageHusa(parameters, {}, {}), std::invalid_argument);
  EXPECT_THROW(SageHusa(parameters, components(5), {}), std::invalid_argument);
  EXPECT_THROW(SageHusa(parameters, components(1, 2.0, 1.0), {}), std::invalid_argument);
  EXPECT_THROW(SageHusa(parameters, components(1), {0.0, 0.0}), std::invalid_argument);
  parameters.forgetting = 1.0;
  EXPECT_THROW(SageHusa(parameters, components(1), {}), std::invalid_argument);
  SageHusa policy(residual_form(), components(2), {});
  std::vector<Feature> features{feature_with(Eigen::MatrixXd::Ones(1, 1))};
  EXPECT_THROW(policy.apply(features), std::invalid_argument);
  features = {feature_with(-Eigen::Matrix2d::Identity())};
  EXPECT_THROW(policy.apply(features), std::invalid_argument);
}
