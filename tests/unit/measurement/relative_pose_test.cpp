#include <numbers>
#include <random>
#include <tests/support/numeric_jacobian.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/measurement/relative_pose.hpp>
#include <libslam/state/planar_pose.hpp>

using namespace libslam;
using libslam::testing::numeric_jacobian;

namespace {

constexpr double kPi = std::numbers::pi;
const BlockSpec kPose{"", Chart::kSE2, 3, WorldRole::kPose};

struct Pair {
  GaussianState state;
  BlockId a, b;
};

Pair make_pair_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Pair pair;
  pair.a = pair.state.add(kPose, a, 1e-4 * Eigen::Matrix3d::Identity());
  pair.b = pair.state.add(kPose, b, 1e-4 * Eigen::Matrix3d::Identity());
  return pair;
}

/// Regimes: zero, 1e-8, headings near +-pi, random.
std::vector<Pair> pairs() {
  std::vector<Pair> all;
  all.push_back(make_pair_of({0, 0, 0}, {0, 0, 0}));
  all.push_back(make_pair_of({0, 0, 0}, {1e-8, -1e-8, 1e-8}));
  all.push_back(make_pair_of({1, 2, kPi - 1e-9}, {3, -1, -kPi + 1e-9}));
  all.push_back(make_pair_of({1, 2, -kPi + 1e-9}, {3, -1, 0.0}));
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto pose = [&] {
    return Eigen::Vector3d(20 * uniform(random), 20 * uniform(random), kPi * uniform(random));
  };
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d a = pose();
    all.push_back(make_pair_of(a, pose()));
  }
  return all;
}

Eigen::Vector3d noise(std::mt19937_64& random, double sigma) {
  std::normal_distribution<double> normal(0.0, sigma);
  const double x = normal(random), y = normal(random);
  return {x, y, normal(random)};
}

}  // namespace

TEST(RelativePose, JacobiansAreTheNumericOnesInEveryRegime) {
  for (const Pair& pair : pairs()) {
    LinearizedMeasurement measurement;
    linearize_relative_pose(pair.state, pair.a, pair.b, Eigen::Vector3d::Zero(),
                            Eigen::Matrix3d::Identity(), measurement);
    for (const auto& [block, jacobian] : measurement.wrt) {
      const Eigen::MatrixXd numeric = numeric_jacobian(
          pair.state, block,
          [&](const GaussianState& state) -> Eigen::VectorXd {
            return relative_pose(state.estimate(pair.a), state.estimate(pair.b));
          },
          kPose);
      // numeric_jacobian.hpp; derivatives grow with the distance of the two.
      EXPECT_LT((jacobian - numeric).cwiseAbs().maxCoeff(),
                1e-8 * (1.0 + numeric.cwiseAbs().maxCoeff()));
    }
  }
}

TEST(RelativePose, HasNoInnovationAtTheTruthAndWrapsIt) {
  Pair pair = make_pair_of({1, 2, 3.0}, {4, -2, -3.0});
  const Eigen::Vector3d T_a_b =
      relative_pose(pair.state.estimate(pair.a), pair.state.estimate(pair.b));
  LinearizedMeasurement measurement;
  linearize_relative_pose(pair.state, pair.a, pair.b, T_a_b + Eigen::Vector3d(0, 0, 2 * kPi),
                          Eigen::Matrix3d::Identity(), measurement);
  EXPECT_LT(measurement.innovation.cwiseAbs().maxCoeff(), 1e-12);
}

// The covariance of the innovation that the Jacobians predict is that of samples. 20000 samples
// tell a variance to 1 % (one sigma): 5 % is five of them.
TEST(RelativePose, PredictsTheSpreadOfSamples) {
  const Pair pair = make_pair_of({3, 1, 0.7}, {5, 4, -1.1});
  LinearizedMeasurement measurement;
  const Eigen::Vector3d T_a_b =
      relative_pose(pair.state.estimate(pair.a), pair.state.estimate(pair.b));
  linearize_relative_pose(pair.state, pair.a, pair.b, T_a_b, Eigen::Matrix3d::Zero(), measurement);
  Eigen::Matrix3d predicted = Eigen::Matrix3d::Zero(), sampled = Eigen::Matrix3d::Zero();
  for (const auto& [block, jacobian] : measurement.wrt)
    predicted += jacobian * pair.state.covariance_of(block) * jacobian.transpose();
  std::mt19937_64 random(8);
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector3d a = Eigen::Vector3d(pair.state.estimate(pair.a)) + noise(random, 0.01);
    const Eigen::Vector3d b = Eigen::Vector3d(pair.state.estimate(pair.b)) + noise(random, 0.01);
    Eigen::Vector3d error = relative_pose(a, b) - T_a_b;
    error.z() = wrap_angle(error.z());
    sampled += error * error.transpose() / kSamples;
  }
  EXPECT_LT((sampled - predicted).norm(), 0.05 * predicted.norm());
}
