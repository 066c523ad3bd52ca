// Iterated corrections: the minimum of the posterior where one linearization misses it, and nothing
// new where the problem is linear.

#include <cmath>
#include <random>
#include <tests/support/random_matrix.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/filter/iterated_update.hpp>
#include <libslam/measurement/stereo_point.hpp>
#include <libslam/state/so3.hpp>

using namespace libslam;
using libslam::testing::random_covariance;
using libslam::testing::random_matrix;

namespace {

constexpr int kMany = 20;

/// A camera whose place along its axis is hardly known, and points about which a little is.
struct Scene {
  explicit Scene(const char* frame) : ekf(make_error_frame(frame)) {
    std::mt19937_64 random(71);
    TangentVector sigma(6);
    sigma << 0.05, 0.05, 2.0, 0.002, 0.002, 0.002;
    BlockVector start(7);
    start << 0, 0, 0, 0, 0, 0, 1;
    pose = state.add({"pose", Chart::kSE3, 6, WorldRole::kPose}, start,
                     MatrixRef(sigma.cwiseAbs2().asDiagonal().toDenseMatrix()));
    const auto camera = std::make_shared<StereoCamera>(
        StereoCamera{700, 700, 600, 180, 0.5, 1200, 360, Eigen::Isometry3d::Identity()});
    const Eigen::Isometry3d T_world_robot =
        Eigen::Translation3d(0.03, -0.02, 1.9) *
        Eigen::Isometry3d(so3_exp(Eigen::Vector3d(0.001, -0.002, 0.001)));
    std::uniform_real_distribution<double> across(-4.0, 4.0), along(8.0, 20.0);
    std::normal_distribution<double> pixel(0.0, 0.5);
    for (int i = 0; i < 12; ++i) {
      const Eigen::Vector3d m(across(random), 0.3 * across(random), along(random));
      const Eigen::Matrix3d cov = 0.04 * random_covariance(3, random);
      const Eigen::Vector3d known = m + cov.llt().matrixL() * random_matrix(3, 1, random);
      landmarks.push_back(
          state.add({"", Chart::kVector, 3, WorldRole::kPoint}, known, MatrixRef(cov)));
      const Eigen::Vector3d p = T_world_robot.inverse() * m;
      Feature& feature = features.emplace_back();
      feature.z =
          Eigen::Vector3d(600 + 700 * p.x() / p.z() + pixel(random),
                          180 + 700 * p.y() / p.z() + pixel(random), 350 / p.z() + pixel(random));
      feature.cov = 0.25 * Eigen::Matrix3d::Identity();
      feature.camera = camera;
    }
  }

  void linearize(std::size_t i, LinearizedMeasurement& out) {
    model.linearize(state, pose, landmarks[i], features[i], out);
    ++calls;
  }
  Correction correct(int linearizations, std::span<const BlockId> considered = {}) {
    measured.assign(features.size(), {});
    for (std::size_t i = 0; i < features.size(); ++i) linearize(i, measured[i]);
    return IteratedUpdate(linearizations)
        .correct(state, ekf, pose, measured, considered,
                 [&](std::size_t i, LinearizedMeasurement& m) { linearize(i, m); });
  }

  GaussianState state;
  Ekf ekf;
  BlockId pose;
  std::vector<BlockId> landmarks;
  std::vector<Feature> features;
  std::vector<LinearizedMeasurement> measured;
  StereoPoint model{3};
  int calls = 0;
};

/// The gradient of the posterior at `after` over that of its prior alone, in the additive error: 0
/// at the minimum.
double gradient_ratio(Scene& before, Scene& after) {
  Eigen::VectorXd prior(before.state.dimension());
  for (const BlockId block : before.state.blocks())
    prior.segment(before.state.offset(block), before.state.size(block)) = boxminus(
        before.state.spec(block), after.state.estimate(block), before.state.estimate(block));
  const Eigen::VectorXd pull = before.state.full_covariance().llt().solve(prior);
  Eigen::VectorXd gradient = pull;
  for (std::size_t i = 0; i < after.features.size(); ++i) {
    LinearizedMeasurement m;
    after.linearize(i, m);
    for (const auto& [block, jacobian] : m.wrt)
      gradient.segment(after.state.offset(block), jacobian.cols()) -=
          jacobian.transpose() * m.cov.inverse() * m.innovation;
  }
  return gradient.norm() / pull.norm();
}

}  // namespace

// In the additive frame the minimum is that of the textbook. What is left is the stopping rule and
// the turn within the step: below 2 milliradians.
TEST(IteratedUpdate, ReachesTheMinimumThatOneLinearizationMisses) {
  Scene before("standard"), once("standard"), iterated("standard");
  EXPECT_TRUE(once.correct(1).applied);
  EXPECT_TRUE(iterated.correct(kMany).applied);
  EXPECT_GT(gradient_ratio(before, once), 1.0);
  EXPECT_LT(gradient_ratio(before, iterated), 0.02);
}

// Another frame has another prior for the same covariance, equal to first order in the turn.
TEST(IteratedUpdate, FramesAgreeWhereTheTurnIsSmall) {
  Scene standard("standard"), invariant("right_invariant");
  standard.correct(kMany);
  invariant.correct(kMany);
  const Eigen::Vector3d apart = standard.state.estimate(standard.pose).head<3>() -
                                invariant.state.estimate(invariant.pose).head<3>();
  const BlockMatrix cov = standard.state.covariance_of(standard.pose);
  EXPECT_LT(apart.norm(), 0.1 * std::sqrt(cov.topLeftCorner(3, 3).trace()));
  EXPECT_NEAR(invariant.state.covariance_of(invariant.pose)(2, 2) / cov(2, 2), 1.0, 0.01);
}

TEST(IteratedUpdate, IsTheCorrectionOfTheEkfWithOneLinearization) {
  for (const char* frame : {"standard", "right_invariant"}) {
    Scene plain(frame), once(frame);
    plain.measured.assign(plain.features.size(), {});
    for (std::size_t i = 0; i < plain.features.size(); ++i) plain.linearize(i, plain.measured[i]);
    plain.ekf.correct(plain.state, plain.pose, plain.measured);
    once.correct(1);
    EXPECT_EQ(plain.state.estimate(plain.pose), once.state.estimate(once.pose));
    EXPECT_EQ(plain.state.full_covariance(), once.state.full_covariance());
  }
}

TEST(IteratedUpdate, StopsWhereTheLinearizationHolds) {
  Scene scene("right_invariant");
  scene.correct(kMany);
  EXPECT_LT(scene.calls, 6 * static_cast<int>(scene.features.size()));
  scene.calls = 0;
  scene.correct(kMany);  // by now the pose is known: one look at the end of the step
  EXPECT_EQ(scene.calls, 2 * static_cast<int>(scene.features.size()));
}

TEST(IteratedUpdate, KeepsConsideredBlocksWhereTheyAre) {
  Scene scene("right_invariant");
  std::vector<Eigen::VectorXd> places;
  for (const BlockId landmark : scene.landmarks) places.push_back(scene.state.estimate(landmark));
  const BlockMatrix cov = scene.state.covariance_of(scene.landmarks.front());
  EXPECT_TRUE(scene.correct(kMany, scene.landmarks).applied);
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_EQ(scene.state.estimate(scene.landmarks[i]), places[i]);
  EXPECT_LT((scene.state.covariance_of(scene.landmarks.front()) - cov).norm(), 1e-12);
}

// A step that leads past a point leaves no innovation there; the step stays.
TEST(IteratedUpdate, EndsWhereAMeasurementCannotBeSeen) {
  Scene once("standard"), blind("standard");
  once.correct(1);
  blind.measured.assign(blind.features.size(), {});
  for (std::size_t i = 0; i < blind.features.size(); ++i) blind.linearize(i, blind.measured[i]);
  const auto nothing = [](std::size_t, LinearizedMeasurement& m) {
    m.innovation.setConstant(std::nan(""));
  };
  EXPECT_TRUE(IteratedUpdate(kMany)
                  .correct(blind.state, blind.ekf, blind.pose, blind.measured, {}, nothing)
                  .applied);
  EXPECT_EQ(blind.state.estimate(blind.pose), once.state.estimate(once.pose));
}

TEST(IteratedUpdate, RefusesToDoWithoutALinearization) {
  EXPECT_THROW(IteratedUpdate(0), std::invalid_argument);
}
