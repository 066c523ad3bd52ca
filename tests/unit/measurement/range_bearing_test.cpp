#include <numbers>
#include <random>
#include <tests/support/numeric_jacobian.hpp>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/measurement/range_bearing.hpp>

using namespace libslam;
using libslam::testing::numeric_jacobian;

namespace {

constexpr double kPi = std::numbers::pi;
// Central differences: see numeric_jacobian.hpp; derivatives grow with 1 / range.
constexpr double kTolerance = 1e-8;

struct Scene {
  GaussianState state;
  BlockId pose, landmark;
  Feature feature;
};

/// A landmark at `range` and `bearing` from a sensor at `T_robot_sensor` on a robot at `pose`.
Scene make_scene(const Eigen::Vector3d& pose, const Eigen::Vector3d& T_robot_sensor, double range,
                 double bearing) {
  Scene scene;
  scene.feature.T_robot_sensor = T_robot_sensor;
  scene.feature.z = Eigen::Vector2d(range, bearing);
  scene.feature.cov = Eigen::Vector2d(0.01, 0.0004).asDiagonal();
  scene.pose = scene.state.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, pose,
                               0.01 * Eigen::Matrix3d::Identity());
  const RangeBearing model;
  Initialization initialization;
  model.initialize(scene.state, scene.pose, scene.feature, initialization);
  scene.landmark = scene.state.augment(model.landmark_spec(), initialization);
  return scene;
}

/// Regimes: zero, 1e-8, near +-pi in heading and bearing, behind the robot, random.
std::vector<Scene> scenes() {
  std::vector<Scene> all;
  const Eigen::Vector3d sensors[] = {{0, 0, 0}, {3.78, 0.5, -1.2}, {-0.2, 0.1, kPi}};
  for (const auto& sensor : sensors) {
    all.push_back(make_scene({0, 0, 0}, sensor, 5.0, 0.0));
    all.push_back(make_scene({1e-8, -1e-8, 1e-8}, sensor, 5.0, 1e-8));
    all.push_back(make_scene({1, 2, kPi - 1e-9}, sensor, 3.0, 0.5));
    all.push_back(make_scene({1, 2, -kPi + 1e-9}, sensor, 3.0, -kPi + 1e-9));
    all.push_back(make_scene({-4, 2, 0.3}, sensor, 2.0, kPi));
    std::mt19937_64 random(71);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < 20; ++i)
      all.push_back(make_scene({50 * uniform(random), 50 * uniform(random), kPi * uniform(random)},
                               sensor, 10.5 + 10 * uniform(random), kPi * uniform(random)));
  }
  return all;
}

Eigen::VectorXd wrapped_difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return Eigen::Vector2d(a[0] - b[0], wrap_angle(a[1] - b[1]));
}

}  // namespace

TEST(RangeBearing, JacobiansAreTheNumericOnesInEveryRegime) {
  const RangeBearing model;
  for (const Scene& scene : scenes()) {
    LinearizedMeasurement measurement;
    model.linearize(scene.state, scene.pose, scene.landmark, scene.feature, measurement);
    ASSERT_EQ(measurement.wrt.size(), 2);
    const auto predict = [&](const GaussianState& state) -> Eigen::VectorXd {
      return model.predict(state, scene.pose, scene.landmark, scene.feature);
    };
    for (const auto& [block, jacobian] : measurement.wrt)
      EXPECT_LT(
          (jacobian - numeric_jacobian(scene.state, block, predict, wrapped_difference)).norm(),
          kTolerance * (1.0 + jacobian.norm()));
  }
}

TEST(RangeBearing, InitializationInvertsThePredictionAndItsJacobianIsTheNumericOne) {
  const RangeBearing model;
  for (const Scene& scene : scenes()) {
    const Eigen::VectorXd predicted =
        model.predict(scene.state, scene.pose, scene.landmark, scene.feature);
    EXPECT_LT(wrapped_difference(predicted, scene.feature.z).norm(), 1e-12);
    Initialization initialization;
    model.initialize(scene.state, scene.pose, scene.feature, initialization);
    const auto place = [&](const GaussianState& state) -> Eigen::VectorXd {
      Initialization moved;
      model.initialize(state, scene.pose, scene.feature, moved);
      return moved.estimate;
    };
    const auto& by_pose = initialization.wrt.begin()->jacobian;
    EXPECT_LT(
        (by_pose - numeric_jacobian(scene.state, scene.pose, place, model.landmark_spec())).norm(),
        kTolerance * (1.0 + by_pose.norm()));
    const Eigen::MatrixXd by_z = numeric_jacobian(scene.feature.z, [&](const Eigen::VectorXd& z) {
      Feature feature = scene.feature;
      feature.z = z;
      Initialization moved;
      model.initialize(scene.state, scene.pose, feature, moved);
      return Eigen::VectorXd(moved.estimate);
    });
    EXPECT_LT((initialization.cov_noise - by_z * scene.feature.cov * by_z.transpose()).norm(),
              1e-7);
  }
}

TEST(RangeBearing, InnovationIsWrappedAcrossPi) {
  Scene scene = make_scene({0, 0, 0}, {0, 0, 0}, 4.0, kPi - 0.01);
  scene.feature.z[1] = -kPi + 0.01;
  LinearizedMeasurement measurement;
  RangeBearing().linearize(scene.state, scene.pose, scene.landmark, scene.feature, measurement);
  EXPECT_NEAR(measurement.innovation[1], 0.02, 1e-12);
  EXPECT_NEAR(measurement.innovation[0], 0.0, 1e-12);
}

// First and second moments of an initialized landmark under small noise; the bounds are five
// standard errors of 20000 samples plus the second-order terms of a 1 % noise.
TEST(RangeBearing, SampledMomentsMatchTheLinearization) {
  std::mt19937_64 random(72);
  std::normal_distribution<double> normal;
  const Eigen::Vector3d T_robot_sensor(0.5, -0.3, 0.7), mean_pose(3, -2, 2.5);
  constexpr double kSigmaPose = 0.01, kSigmaRange = 0.02, kSigmaBearing = 0.005;
  constexpr int kSamples = 20000;
  Scene scene = make_scene(mean_pose, T_robot_sensor, 6.0, 0.8);
  scene.feature.cov =
      Eigen::Vector2d(kSigmaRange * kSigmaRange, kSigmaBearing * kSigmaBearing).asDiagonal();
  const RangeBearing model;
  Initialization linear;
  model.initialize(scene.state, scene.pose, scene.feature, linear);
  const Eigen::MatrixXd g = linear.wrt.begin()->jacobian;
  const Eigen::Matrix2d expected =
      kSigmaPose * kSigmaPose * g * g.transpose() + Eigen::MatrixXd(linear.cov_noise);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d outer = Eigen::Matrix2d::Zero();
  for (int i = 0; i < kSamples; ++i) {
    GaussianState moved = scene.state;
    moved.set_estimate(
        scene.pose,
        mean_pose + kSigmaPose * Eigen::Vector3d(normal(random), normal(random), normal(random)));
    Feature feature = scene.feature;
    feature.z += Eigen::Vector2d(kSigmaRange * normal(random), kSigmaBearing * normal(random));
    Initialization sample;
    model.initialize(moved, scene.pose, feature, sample);
    const Eigen::Vector2d deviation = sample.estimate - linear.estimate;
    sum += deviation;
    outer += deviation * deviation.transpose();
  }
  const double scale = expected.trace();
  EXPECT_LT((sum / kSamples).norm(), 5 * std::sqrt(scale / kSamples) + 0.01 * std::sqrt(scale));
  EXPECT_LT((outer / kSamples - expected).norm(), (5 * std::sqrt(2.0 / kSamples) + 0.01) * scale);
}
