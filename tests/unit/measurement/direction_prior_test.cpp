#include <numbers>
#include <random>
#include <tests/support/numeric_jacobian.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/measurement/direction_prior.hpp>

using namespace libslam;
using libslam::testing::numeric_jacobian;

namespace {

constexpr double kPi = std::numbers::pi;

struct Scene {
  GaussianState state;
  BlockId direction, line;
};

Scene make_scene(double psi, double alpha) {
  Scene scene;
  scene.direction =
      scene.state.add(DirectionPrior::direction_spec(), Eigen::VectorXd::Constant(1, psi),
                      Eigen::MatrixXd::Identity(1, 1));
  scene.line = scene.state.add({"", Chart::kLine, 2, WorldRole::kLine}, Eigen::Vector2d(alpha, 4.0),
                               Eigen::Matrix2d::Identity());
  return scene;
}

/// Zero, 1e-8, near +-pi of both, random; none at the jump halfway between two directions.
std::vector<Scene> scenes() {
  std::vector<Scene> all;
  for (const auto& [psi, alpha] :
       {std::pair(0.0, 0.0), std::pair(1e-8, -1e-8), std::pair(kPi - 1e-9, -kPi + 1e-9),
        std::pair(-kPi + 1e-9, 0.5 * kPi), std::pair(0.3, kPi)})
    all.push_back(make_scene(psi, alpha));
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> uniform(-kPi, kPi);
  while (all.size() < 30) {
    const double psi = uniform(random), alpha = uniform(random);
    if (std::abs(std::remainder(alpha - psi, 0.5 * kPi)) < 0.75)
      all.push_back(make_scene(psi, alpha));
  }
  return all;
}

}  // namespace

TEST(DirectionPrior, JacobiansAreTheNumericOnesInEveryRegime) {
  const DirectionPrior model(0.05);
  for (const Scene& scene : scenes()) {
    LinearizedMeasurement out;
    model.linearize(scene.state, scene.direction, scene.line, out);
    ASSERT_EQ(out.wrt.size(), 2);
    EXPECT_NEAR(out.cov(0, 0), 0.0025, 1e-15);
    const auto predict = [&](const GaussianState& state) -> Eigen::VectorXd {
      LinearizedMeasurement moved;
      model.linearize(state, scene.direction, scene.line, moved);
      return -moved.innovation;  // z is zero
    };
    for (const auto& [block, jacobian] : out.wrt)
      EXPECT_LT((jacobian - numeric_jacobian(scene.state, block, predict,
                                             [](const auto& a, const auto& b) -> Eigen::VectorXd {
                                               return a - b;
                                             }))
                    .norm(),
                1e-8);
  }
}

TEST(DirectionPrior, WallsAtRightAnglesAreWhereTheyShouldBe) {
  const DirectionPrior model(0.05);
  for (int quarter = -2; quarter <= 2; ++quarter) {
    const Scene scene = make_scene(0.3, wrap_angle(0.3 + 0.5 * quarter * kPi));
    LinearizedMeasurement out;
    model.linearize(scene.state, scene.direction, scene.line, out);
    EXPECT_NEAR(out.innovation[0], 0.0, 1e-12);
  }
  const Scene scene = make_scene(0.3, 0.3 + 0.5 * kPi + 0.1);
  LinearizedMeasurement out;
  model.linearize(scene.state, scene.direction, scene.line, out);
  EXPECT_NEAR(out.innovation[0], -0.1, 1e-12);
}

// The innovation of walls that stray by sigma has the covariance R; sqrt(2 / n) is the scatter of a
// sampled variance, five of these are allowed.
TEST(DirectionPrior, SamplesFollowTheLinearization) {
  constexpr int kSamples = 20000;
  constexpr double kSigma = 0.05;
  const DirectionPrior model(kSigma);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, kSigma);
  double sum = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const Scene scene = make_scene(3.0, wrap_angle(3.0 + 0.5 * (i % 4) * kPi + normal(random)));
    LinearizedMeasurement out;
    model.linearize(scene.state, scene.direction, scene.line, out);
    sum += out.innovation.squaredNorm() / out.cov(0, 0);
  }
  EXPECT_NEAR(sum / kSamples, 1.0, 5.0 * std::sqrt(2.0 / kSamples));
}

TEST(DirectionPrior, RefusesASpreadThatIsNone) {
  EXPECT_THROW(DirectionPrior(0.0), std::invalid_argument);
  EXPECT_THROW(DirectionPrior(-1.0), std::invalid_argument);
}
