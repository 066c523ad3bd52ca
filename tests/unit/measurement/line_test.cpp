#include <numbers>
#include <random>
#include <tests/support/numeric_jacobian.hpp>
#include <tests/support/random_matrix.hpp>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/measurement/line.hpp>

using namespace libslam;
using libslam::testing::numeric_jacobian;

namespace {

constexpr double kPi = std::numbers::pi;
// Central differences: see numeric_jacobian.hpp; derivatives grow with the distance from the
// origin of the world.
constexpr double kTolerance = 1e-8;

struct Scene {
  GaussianState state;
  BlockId pose, landmark;
  Feature feature;
};

/// A wall at (alpha, r) from a sensor at `T_robot_sensor` on a robot at `pose`.
Scene make_scene(const Eigen::Vector3d& pose, const Eigen::Vector3d& T_robot_sensor, double alpha,
                 double r) {
  Scene scene;
  scene.feature.T_robot_sensor = T_robot_sensor;
  scene.feature.z = Eigen::Vector2d(alpha, r);
  scene.feature.cov = Eigen::Vector2d(4e-4, 9e-4).asDiagonal();
  scene.feature.extent = Extent{-1.0, 2.5, 0.02, 0.03};
  scene.pose = scene.state.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, pose,
                               0.01 * Eigen::Matrix3d::Identity());
  const LineMeasurement model;
  Initialization initialization;
  model.initialize(scene.state, scene.pose, scene.feature, initialization);
  scene.landmark = scene.state.augment(model.landmark_spec(), initialization);
  return scene;
}

/// Regimes: zero, 1e-8, near +-pi in heading and normal, through the origin, random.
std::vector<Scene> scenes() {
  std::vector<Scene> all;
  const Eigen::Vector3d sensors[] = {{0, 0, 0}, {0.4, 0.1, -1.2}, {-0.2, 0.1, kPi}};
  for (const auto& sensor : sensors) {
    all.push_back(make_scene({0, 0, 0}, sensor, 0.0, 5.0));
    all.push_back(make_scene({1e-8, -1e-8, 1e-8}, sensor, 1e-8, 5.0));
    all.push_back(make_scene({1, 2, kPi - 1e-9}, sensor, 0.5, 3.0));
    all.push_back(make_scene({1, 2, -kPi + 1e-9}, sensor, -kPi + 1e-9, 3.0));
    all.push_back(make_scene({-3, 0, 0}, {0, 0, 0}, 0.0, 3.0));  // r_w = 0
    std::mt19937_64 random(71);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < 20; ++i)
      all.push_back(make_scene({50 * uniform(random), 50 * uniform(random), kPi * uniform(random)},
                               sensor, kPi * uniform(random), 5.5 + 5 * uniform(random)));
  }
  return all;
}

Eigen::VectorXd wrapped_difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return Eigen::Vector2d(wrap_angle(a[0] - b[0]), a[1] - b[1]);
}

}  // namespace

TEST(LineMeasurement, JacobiansAreTheNumericOnesInEveryRegime) {
  const LineMeasurement model;
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

TEST(LineMeasurement, InitializationInvertsThePredictionAndItsJacobianIsTheNumericOne) {
  const LineMeasurement model;
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
  }
}

// Errors small enough that second-order terms, sigma^2 times the distance from the origin, stay
// below the scatter of a sampled covariance, sqrt(2 / n) of its entries; five of these are allowed.
TEST(LineMeasurement, SamplesFollowTheLinearization) {
  constexpr int kSamples = 20000;
  const LineMeasurement model;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const Scene scene = make_scene({4, -3, 0.7}, {0.4, 0.1, -1.2}, 2.0, 3.0);
  const Eigen::Vector3d sigma_pose(1e-3, 2e-3, 1e-4);
  const Eigen::Vector2d sigma_z(1e-4, 1e-3);
  Initialization exact;
  model.initialize(scene.state, scene.pose, scene.feature, exact);
  Eigen::MatrixX2d errors(kSamples, 2);
  for (int i = 0; i < kSamples; ++i) {
    GaussianState state = scene.state;
    Feature feature = scene.feature;
    Eigen::Vector3d pose = state.estimate(scene.pose);
    for (int k = 0; k < 3; ++k) pose[k] += sigma_pose[k] * normal(random);
    for (int k = 0; k < 2; ++k) feature.z[k] += sigma_z[k] * normal(random);
    state.set_estimate(scene.pose, pose);
    Initialization sample;
    model.initialize(state, scene.pose, feature, sample);
    errors.row(i) = wrapped_difference(sample.estimate, exact.estimate).transpose();
  }
  const Eigen::Matrix2d sampled = errors.transpose() * errors / kSamples;
  Feature small = scene.feature;
  small.cov = sigma_z.cwiseAbs2().asDiagonal();
  model.initialize(scene.state, scene.pose, small, exact);
  const Eigen::MatrixXd by_pose = exact.wrt.begin()->jacobian;
  const Eigen::Matrix2d expected =
      by_pose * sigma_pose.cwiseAbs2().asDiagonal() * by_pose.transpose() + exact.cov_noise;
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 2; ++k)
      EXPECT_NEAR(sampled(i, k), expected(i, k),
                  5.0 * std::sqrt(2.0 / kSamples * expected(i, i) * expected(k, k)));
}

TEST(LineMeasurement, TheTwoSidesOfAWallAreHalfATurnApart) {
  const LineMeasurement model;
  const Scene before = make_scene({0, 0, 0}, {0, 0, 0}, 0.0, 5.0);  // wall x = 5, seen from x = 0
  const Scene behind = make_scene({9, 0, 0}, {0, 0, 0}, kPi, 4.0);  // seen from x = 9
  const Eigen::VectorXd front = before.state.estimate(before.landmark),
                        back = behind.state.estimate(behind.landmark);
  EXPECT_NEAR(std::abs(wrap_angle(front[0] - back[0])), kPi, 1e-12);
  EXPECT_NEAR(front[1], 5.0, 1e-12);
  EXPECT_NEAR(back[1], -5.0, 1e-12);
}

TEST(LineMeasurement, ThePartSeenStaysWhereItIsInTheWorld) {
  const LineMeasurement model;
  for (const Scene& scene : scenes()) {
    const auto part = model.sighted_part(scene.state, scene.pose, scene.landmark, scene.feature);
    ASSERT_TRUE(part);
    const Eigen::Vector3d pose = scene.state.estimate(scene.pose);
    const Eigen::Vector2d line = scene.state.estimate(scene.landmark);
    const Eigen::Vector2d n(std::cos(line[0]), std::sin(line[0])), along(-n.y(), n.x());
    const double theta = scene.feature.T_robot_sensor[2];
    const Eigen::Vector2d n_robot(std::cos(scene.feature.z[0] + theta),
                                  std::sin(scene.feature.z[0] + theta));
    const Eigen::Vector2d end_robot =
        scene.feature.T_robot_sensor.head<2>() + scene.feature.z[1] * n_robot +
        scene.feature.extent->end * Eigen::Vector2d(-n_robot.y(), n_robot.x());
    const Eigen::Vector2d end_world = pose.head<2>() + Eigen::Rotation2Dd(pose[2]) * end_robot;
    EXPECT_LT((line[1] * n + part->end * along - end_world).norm(), 1e-9);
    EXPECT_NEAR(part->length(), scene.feature.extent->length(), 1e-9);
  }
}

TEST(LineMeasurement, DifferenceIsZeroForOneWallAndRefusedForTwo) {
  const LineMeasurement model({0.02, 0.03});
  Scene scene = make_scene({3, 4, 0.5}, {0, 0, 0}, 0.3, 2.0);
  Initialization again;
  model.initialize(scene.state, scene.pose, scene.feature, again);
  const BlockId twin = scene.state.augment(model.landmark_spec(), again);
  const Extent part = *model.sighted_part(scene.state, scene.pose, scene.landmark, scene.feature);
  LinearizedMeasurement out;
  ASSERT_TRUE(model.difference(scene.state, {scene.landmark, part}, {twin, part}, 0.6, out));
  EXPECT_LT(out.innovation.norm(), 1e-12);
  EXPECT_EQ(out.wrt.size(), 2);
  const Extent beyond{part.end + 0.7, part.end + 2.0, 0.01, 0.01};
  EXPECT_FALSE(model.difference(scene.state, {scene.landmark, part}, {twin, beyond}, 0.6, out));
  Eigen::VectorXd turned = scene.state.estimate(twin);
  turned[0] = wrap_angle(turned[0] + kPi);
  scene.state.set_estimate(twin, turned);
  EXPECT_FALSE(model.difference(scene.state, {scene.landmark, part}, {twin, part}, 100.0, out));
}
