// The noise estimator on problems whose answer is known.

#include <cmath>
#include <random>
#include <tests/support/random_matrix.hpp>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/policy/sage_husa.hpp>
#include <libslam/state/chi_square.hpp>

using namespace libslam;
using libslam::testing::random_covariance;
using libslam::testing::random_matrix;

namespace {

NoiseAdaptationParameters residual_form() {
  NoiseAdaptationParameters parameters;
  parameters.method = "residual";
  parameters.forgetting = 0.98;
  return parameters;
}

std::vector<NoiseComponent> components(int dimension, double floor = 1e-6, double ceiling = 1e6) {
  std::vector<NoiseComponent> all;
  for (int i = 0; i < dimension; ++i)
    all.push_back({std::string(1, static_cast<char>('a' + i)), 1.0, floor, ceiling, 0.0});
  return all;
}

Feature feature_with(const Eigen::MatrixXd& cov, std::int64_t id = 1) {
  Feature feature;
  feature.id = id;
  feature.z = Eigen::VectorXd::Ones(cov.rows());
  feature.cov = cov;
  return feature;
}

/// What a correction leaves of a measurement alone, given H P- H^T.
Postfit postfit_of(const Eigen::MatrixXd& predicted, const Eigen::MatrixXd& r,
                   const Eigen::VectorXd& nu, std::size_t feature = 0) {
  const Eigen::MatrixXd s = predicted + r;
  Postfit postfit;
  postfit.feature = feature;
  postfit.innovation = nu;
  postfit.cov_innovation = s;
  postfit.residual = r * s.ldlt().solve(nu);
  postfit.cov_predicted = r - r * s.ldlt().solve(r);
  return postfit;
}

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
    if (nu.dot((predicted + r).ldlt().solve(nu)) <= gate)
      policy.observe(features, std::vector{postfit_of(predicted, r, nu)});
    if (2 * k >= updates) sum += r;
  }
  return sum / (updates - (updates + 1) / 2);
}

}  // namespace

TEST(SageHusa, ScalarRecursionByHand) {
  NoiseAdaptationParameters parameters = residual_form();
  parameters.forgetting = 0.9;
  parameters.prior_weight = 3;
  SageHusa policy(parameters, components(1), {});
  double r = 4.0;
  const double predicted = 1.5;
  const double innovations[] = {1.0, -3.0, 0.2, 7.0};
  for (int k = 0; k < 4; ++k) {
    std::vector<Feature> features{feature_with(Eigen::MatrixXd::Constant(1, 1, 4.0))};
    policy.apply(features);
    ASSERT_NEAR(features[0].cov(0, 0), r, 1e-13);
    const Eigen::VectorXd nu = Eigen::VectorXd::Constant(1, innovations[k]);
    policy.observe(features, std::vector{postfit_of(Eigen::MatrixXd::Constant(1, 1, predicted),
                                                    features[0].cov, nu)});
    const double s = predicted + r, e = r / s * innovations[k], c = r - r * r / s;
    const double d = (1.0 - 0.9) / (1.0 - std::pow(0.9, k + 3));
    r = (1.0 - d) * r + d * (e * e + c);
  }
  EXPECT_NEAR(policy.noise()[0].sigma, std::sqrt(r), 1e-13);
  EXPECT_NEAR(policy.noise()[0].configured, 2.0, 1e-13);
}

TEST(SageHusa, ClassicRecursionByHandAndItsRepair) {
  NoiseAdaptationParameters parameters = residual_form();
  parameters.method = "classic";
  parameters.forgetting = 0.5;
  parameters.prior_weight = 1;  // d = 1 at first: the prior counts for nothing
  for (const double floor : {0.0, 0.25}) {
    parameters.eigenvalue_floor = floor;
    SageHusa policy(parameters, components(1), {});
    std::vector<Feature> features{feature_with(Eigen::MatrixXd::Constant(1, 1, 4.0))};
    policy.apply(features);
    const Eigen::MatrixXd predicted = Eigen::MatrixXd::Constant(1, 1, 3.0);
    const Eigen::VectorXd nu = Eigen::VectorXd::Constant(1, 1.0);
    policy.observe(features, std::vector{postfit_of(predicted, features[0].cov, nu)});
    features = {feature_with(Eigen::MatrixXd::Constant(1, 1, 4.0))};
    policy.apply(features);
    // nu^2 - H P- H^T = -2: not a variance, unless it is repaired.
    EXPECT_NEAR(features[0].cov(0, 0), floor > 0.0 ? 1.0 : -2.0, 1e-13);
  }
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
    policy.observe(features,
                   std::vector{postfit_of(predicted, r, random_matrix(n, 1, random, surprise))});
  }
}

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
    policy.observe(features, std::vector{postfit_of(Eigen::MatrixXd::Zero(1, 1), features[0].cov,
                                                    Eigen::VectorXd::Constant(1, normal(random)))});
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

TEST(SageHusa, CovariancesKeepTheirSizesRelativeToEachOther) {
  SageHusa policy(residual_form(), components(2), {});
  const Eigen::MatrixXd small = Eigen::Vector2d(0.01, 0.04).asDiagonal();
  std::mt19937_64 random(64);
  for (int k = 0; k < 50; ++k) {
    std::vector<Feature> features{feature_with(small), feature_with(9.0 * small)};
    policy.apply(features);
    EXPECT_LT((features[1].cov - 9.0 * features[0].cov).norm(), 1e-12 * features[1].cov.norm());
    const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(2, 2);
    policy.observe(
        features,
        std::vector{postfit_of(nothing, features[0].cov, 0.3 * random_matrix(2, 1, random), 0),
                    postfit_of(nothing, features[1].cov, 0.9 * random_matrix(2, 1, random), 1)});
  }
}

TEST(SageHusa, AShapeGrowsWithTheDistanceOfRangeOrStereoPoint) {
  std::vector<NoiseComponent> shaped = components(2);
  shaped[0].growth_per_m = 0.1;
  SageHusa range_bearing(residual_form(), shaped, {});
  std::vector<Feature> features{feature_with(Eigen::Matrix2d::Identity())};
  features[0].z = Eigen::Vector2d(20.0, 0.5);
  range_bearing.apply(features);
  EXPECT_NEAR(features[0].cov(0, 0), 9.0, 1e-12);
  EXPECT_NEAR(features[0].cov(1, 1), 1.0, 1e-12);
  EXPECT_NEAR(range_bearing.noise()[0].sigma, 1.0, 1e-12);  // at distance 0

  auto camera = std::make_shared<StereoCamera>();
  camera->fx = 400.0;
  camera->baseline = 0.25;
  shaped = components(3);
  shaped[2].growth_per_m = 0.5;
  SageHusa stereo(residual_form(), shaped, {});
  features = {feature_with(Eigen::Matrix3d::Identity())};
  features[0].camera = camera;
  features[0].z = Eigen::Vector3d(300.0, 200.0, 25.0);  // at 4 m
  stereo.apply(features);
  EXPECT_NEAR(features[0].cov(2, 2), 9.0, 1e-12);
}

TEST(SageHusa, SigmaStaysBetweenFloorAndCeiling) {
  SageHusa policy(residual_form(), components(2, 0.5, 2.0), {});
  Eigen::MatrixXd cov;
  for (const double size : {0.0, 100.0}) {
    for (int k = 0; k < 2000; ++k) {
      std::vector<Feature> features{feature_with(Eigen::Matrix2d::Identity())};
      policy.apply(features);
      cov = features[0].cov;
      policy.observe(features, std::vector{postfit_of(Eigen::MatrixXd::Zero(2, 2), cov,
                                                      Eigen::Vector2d(size, -size))});
      ASSERT_EQ(Eigen::LLT<Eigen::MatrixXd>(cov).info(), Eigen::Success) << k;
    }
    const double limit = size > 0.0 ? 2.0 : 0.5;
    EXPECT_NEAR(std::sqrt(cov(0, 0)), limit, 1e-9);
    EXPECT_NEAR(policy.noise()[1].sigma, limit, 1e-9);
  }
}

TEST(SageHusa, SensorsLearnApartAndFurtherOnesShareTheLast) {
  NoiseAdaptationParameters parameters = residual_form();
  parameters.channels = 2;
  SageHusa policy(parameters, components(1), {});
  for (int k = 0; k < 500; ++k) {
    std::vector<Feature> features(3, feature_with(Eigen::MatrixXd::Ones(1, 1)));
    for (int i = 0; i < 3; ++i) features[static_cast<std::size_t>(i)].channel = i;
    policy.apply(features);
    std::vector<Postfit> corrected;
    for (std::size_t i = 0; i < 3; ++i)
      corrected.push_back(postfit_of(Eigen::MatrixXd::Zero(1, 1), features[i].cov,
                                     Eigen::VectorXd::Constant(1, i == 0 ? 2.0 : 0.5), i));
    policy.observe(features, corrected);
  }
  const std::vector<AdaptedNoise> noise = policy.noise();
  ASSERT_EQ(noise.size(), 2U);
  EXPECT_EQ(noise[0].name, "a_1");
  EXPECT_EQ(noise[1].name, "a_2");
  EXPECT_NEAR(noise[0].sigma, 2.0, 1e-3);  // .98^500 = 4e-5 of the start is left
  EXPECT_NEAR(noise[1].sigma, 0.5, 1e-3);
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
    policy.observe(features, std::vector{postfit_of(Eigen::MatrixXd::Zero(1, 1), features[0].cov,
                                                    Eigen::VectorXd::Constant(1, z))});
    if (k >= 2000) sum += policy.bias(0)[0];
  }
  EXPECT_NEAR(sum / 2000, 0.5, 4.0 * 0.1 / std::sqrt(2000.0));
  EXPECT_NEAR(policy.noise()[0].sigma, 0.1, 0.1 * 0.5);  // spread of R 14 % at .98, four of them
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
