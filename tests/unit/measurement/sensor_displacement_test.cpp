#include <numbers>
#include <random>
#include <tests/support/numeric_jacobian.hpp>
#include <tests/support/random_matrix.hpp>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/poses/CPose2D.h>

#include <libslam/measurement/sensor_displacement.hpp>

using namespace libslam;
using libslam::testing::numeric_jacobian;
using libslam::testing::random_matrix;
using mrpt::poses::CPose2D;

namespace {

constexpr double kPi = std::numbers::pi;
// Central differences: see numeric_jacobian.hpp; coordinates stay below 10 m.
constexpr double kTolerance = 1e-8;

CPose2D pose_of(const Eigen::VectorXd& p) {
  return {p[0], p[1], p[2]};
}

Eigen::Vector3d vector_of(const CPose2D& p) {
  return {p.x(), p.y(), p.phi()};
}

CalibrationParameters all_enabled() {
  CalibrationParameters calibration;
  calibration.sensor_x.enabled = calibration.sensor_y.enabled = calibration.sensor_phi.enabled =
      true;
  return calibration;
}

Feature reading_at(const Eigen::Vector3d& pose) {
  Feature reading;
  reading.z = pose;
  reading.cov = Eigen::Vector3d(1e-6, 2e-6, 3e-6).asDiagonal();
  return reading;
}

struct Scene {
  GaussianState state;
  PosePair poses;
  CalibrationBlocks blocks;
};

/// A robot with a sensor at `sensor`, first at `before`, now displaced by `moved` from there.
Scene make_scene(const Eigen::Vector3d& before, const Eigen::Vector3d& moved,
                 const Eigen::Vector3d& sensor) {
  Scene scene;
  const auto add_pose = [&](const char* name, const Eigen::Vector3d& pose) {
    return scene.state.add({name, Chart::kSE2, 3, WorldRole::kPose}, pose,
                           0.01 * Eigen::Matrix3d::Identity());
  };
  scene.poses.now = add_pose("now", vector_of(pose_of(before) + pose_of(moved)));
  scene.poses.before = add_pose("before", before);
  for (const double value : sensor)
    scene.blocks.push_back(scene.state.add({"sensor", Chart::kVector, 1, WorldRole::kNone},
                                           Eigen::VectorXd::Constant(1, value),
                                           Eigen::MatrixXd::Constant(1, 1, 0.01)));
  return scene;
}

/// Regimes: zero, 1e-8, headings and turns near +-pi, random.
std::vector<Scene> scenes() {
  std::vector<Scene> all;
  for (const Eigen::Vector3d& sensor :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1e-8, -1e-8, 1e-8),
        Eigen::Vector3d(-0.4, 0.3, -1.86), Eigen::Vector3d(0.2, -0.1, kPi - 1e-9)}) {
    all.push_back(make_scene({0, 0, 0}, {0, 0, 0}, sensor));
    all.push_back(make_scene({1e-8, -1e-8, 1e-8}, {1e-8, 1e-8, -1e-8}, sensor));
    all.push_back(make_scene({1, 2, kPi - 1e-9}, {0.3, 0.1, 2e-9}, sensor));
    all.push_back(make_scene({1, 2, 0.4}, {0.3, 0.1, kPi - 1e-3}, sensor));
    all.push_back(make_scene({1, 2, -kPi + 0.2}, {-0.3, 0.1, -kPi + 1e-3}, sensor));
    std::mt19937_64 random(181);
    for (int i = 0; i < 20; ++i)
      all.push_back(
          make_scene(random_matrix(3, 1, random, 2.0), random_matrix(3, 1, random, 0.8), sensor));
  }
  return all;
}

Eigen::VectorXd wrapped_difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  Eigen::Vector3d difference = a - b;
  difference[2] = wrap_angle(difference[2]);
  return difference;
}

}  // namespace

TEST(SensorDisplacement, PredictsWhatThePosesOfTheSensorSay) {
  const SensorDisplacement model(all_enabled());
  for (const Scene& scene : scenes()) {
    Eigen::Vector3d sensor;
    for (Eigen::Index i = 0; i < 3; ++i)
      sensor[i] = scene.state.estimate(scene.blocks[static_cast<std::size_t>(i)])[0];
    const CPose2D before = pose_of(scene.state.estimate(scene.poses.before)) + pose_of(sensor);
    const CPose2D now = pose_of(scene.state.estimate(scene.poses.now)) + pose_of(sensor);
    EXPECT_LT(wrapped_difference(model.predict(scene.state, scene.poses, scene.blocks),
                                 vector_of(now - before))
                  .norm(),
              1e-12);
  }
}

TEST(SensorDisplacement, JacobiansAreTheNumericOnesInEveryRegime) {
  const SensorDisplacement model(all_enabled());
  for (const Scene& scene : scenes()) {
    LinearizedMeasurement measurement;
    model.linearize(scene.state, scene.poses, scene.blocks, reading_at({0, 0, 0}),
                    reading_at({1, 2, 3}), measurement);
    ASSERT_EQ(measurement.wrt.size(), 5);
    const auto predict = [&](const GaussianState& state) -> Eigen::VectorXd {
      return model.predict(state, scene.poses, scene.blocks);
    };
    for (const auto& [block, jacobian] : measurement.wrt)
      EXPECT_LT(
          (jacobian - numeric_jacobian(scene.state, block, predict, wrapped_difference)).norm(),
          kTolerance * (1.0 + jacobian.norm()))
          << scene.state.spec(block).name;
  }
}

TEST(SensorDisplacement, InnovationComparesReadingsWhereverTheirPathLiesAndIsWrapped) {
  const SensorDisplacement model(all_enabled());
  for (const Scene& scene : scenes()) {
    const CPose2D origin(3.0, -4.0, 2.0), error(1e-3, -2e-3, 4e-3);
    const CPose2D exact = pose_of(model.predict(scene.state, scene.poses, scene.blocks));
    const Eigen::Vector3d measured = vector_of(exact) + vector_of(error);
    LinearizedMeasurement measurement;
    model.linearize(scene.state, scene.poses, scene.blocks, reading_at(vector_of(origin)),
                    reading_at(vector_of(origin + pose_of(measured))), measurement);
    EXPECT_LT((measurement.innovation - vector_of(error)).norm(), 1e-12);
    EXPECT_EQ(measurement.cov, reading_at({0, 0, 0}).cov);
  }
}

TEST(SensorDisplacement, ParametersThatAreNotEnabledAreConstants) {
  CalibrationParameters calibration = all_enabled();
  calibration.sensor_y = {false, 0.3, 0.1, 0.0};
  const SensorDisplacement model(calibration);
  ASSERT_EQ(model.calibration().size(), 2u);
  EXPECT_EQ(model.calibration()[1].name, "sensor_phi");
  Scene scene = make_scene({1, 2, 0.5}, {0.2, 0.1, 0.7}, {0.1, 0.3, -0.4});
  const MeasurementVector all =
      SensorDisplacement(all_enabled()).predict(scene.state, scene.poses, scene.blocks);
  scene.blocks.erase(scene.blocks.begin() + 1);
  EXPECT_EQ(model.predict(scene.state, scene.poses, scene.blocks), all);
  scene.blocks.pop_back();
  EXPECT_THROW(static_cast<void>(model.predict(scene.state, scene.poses, scene.blocks)),
               std::invalid_argument);
}

TEST(SensorDisplacement, PositionShowsInTurnsAndDirectionInTranslation) {
  const SensorDisplacement model(all_enabled());
  EXPECT_EQ(model.excitation({0.3, 0.1, 0.0}).leftCols<2>().norm(), 0.0);
  EXPECT_EQ(model.excitation({0.0, 0.0, 0.4}).col(2).norm(), 0.0);
  EXPECT_DOUBLE_EQ(model.excitation({0.0, 0.0, 0.4}).col(0).norm(), 0.4);
  EXPECT_DOUBLE_EQ(model.excitation({0.3, 0.4, 0.1}).col(2).norm(), 0.5);
}

// Moments of the prediction under small errors of both poses and the sensor; the bounds are five
// standard errors of the samples plus the second-order terms of errors of 1 %.
TEST(SensorDisplacement, SampledMomentsMatchTheLinearization) {
  constexpr double kSigma = 0.01;
  constexpr int kSamples = 20000;
  const SensorDisplacement model(all_enabled());
  const Scene scene = make_scene({3, -2, 2.5}, {0.4, 0.1, 0.9}, {0.5, -0.3, 0.7});
  LinearizedMeasurement linear;
  model.linearize(scene.state, scene.poses, scene.blocks, reading_at({0, 0, 0}),
                  reading_at({0, 0, 0}), linear);
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  for (const auto& [block, jacobian] : linear.wrt)
    expected += kSigma * kSigma * jacobian * jacobian.transpose();
  const Eigen::VectorXd centre = model.predict(scene.state, scene.poses, scene.blocks);
  std::mt19937_64 random(182);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kSamples; ++i) {
    GaussianState moved = scene.state;
    for (const auto& [block, jacobian] : linear.wrt)
      moved.set_estimate(
          block, scene.state.estimate(block) + random_matrix(jacobian.cols(), 1, random, kSigma));
    const Eigen::Vector3d deviation =
        wrapped_difference(model.predict(moved, scene.poses, scene.blocks), centre);
    sum += deviation;
    outer += deviation * deviation.transpose();
  }
  const double scale = expected.trace();
  EXPECT_LT((sum / kSamples).norm(), 5 * std::sqrt(scale / kSamples) + 0.01 * std::sqrt(scale));
  EXPECT_LT((outer / kSamples - expected).norm(), (5 * std::sqrt(2.0 / kSamples) + 0.01) * scale);
}
