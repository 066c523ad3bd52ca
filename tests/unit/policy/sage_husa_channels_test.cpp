// Noises that the estimator tells apart or keeps in proportion, and their bounds.

#include <cmath>
#include <random>
#include <tests/support/random_matrix.hpp>
#include <tests/unit/policy/noise_problem.hpp>
#include <vector>

#include <gtest/gtest.h>

using namespace libslam;
using namespace libslam::test;
using libslam::testing::random_matrix;

TEST(SageHusa, CovariancesKeepTheirSizesRelativeToEachOther) {
  SageHusa policy(residual_form(), components(2), {});
  const Eigen::MatrixXd small = Eigen::Vector2d(0.01, 0.04).asDiagonal();
  std::mt19937_64 random(64);
  for (int k = 0; k < 50; ++k) {
    std::vector<Feature> features{feature_with(small), feature_with(9.0 * small)};
    policy.apply(features);
    EXPECT_LT((features[1].cov - 9.0 * features[0].cov).norm(), 1e-12 * features[1].cov.norm());
    const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(2, 2);
    const Eigen::VectorXd first = 0.3 * random_matrix(2, 1, random);
    learn(policy, features, nothing, {first, 0.9 * random_matrix(2, 1, random)});
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
      learn(policy, features, Eigen::MatrixXd::Zero(2, 2), {Eigen::Vector2d(size, -size)});
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
    std::vector<Eigen::VectorXd> nu;
    for (int i = 0; i < 3; ++i) nu.push_back(Eigen::VectorXd::Constant(1, i == 0 ? 2.0 : 0.5));
    learn(policy, features, Eigen::MatrixXd::Zero(1, 1), nu);
  }
  const std::vector<AdaptedNoise> noise = policy.noise();
  ASSERT_EQ(noise.size(), 2U);
  EXPECT_EQ(noise[0].name, "a_1");
  EXPECT_EQ(noise[1].name, "a_2");
  EXPECT_NEAR(noise[0].sigma, 2.0, 1e-3);  // .98^500 = 4e-5 of the start is left
  EXPECT_NEAR(noise[1].sigma, 0.5, 1e-3);
}
