#include <tests/support/numeric_jacobian.hpp>
#include <tests/unit/batch/batch_world.hpp>

#include <gtest/gtest.h>

#include <libslam/batch/motion_chain.hpp>
#include <libslam/filter/ekf.hpp>

using namespace libslam;
using namespace libslam::testing;

namespace {

CalibrationParameters wheel_scales() {
  CalibrationParameters calibration;
  calibration.scale_left.enabled = calibration.scale_right.enabled = true;
  return calibration;
}

std::vector<std::optional<MotionAction>> some_motions(int count) {
  std::mt19937_64 random(301);
  SlamWorld world;
  std::vector<std::optional<MotionAction>> motions;
  for (int i = 0; i < count; ++i) motions.emplace_back(world.drive(random, 1.0));
  motions.emplace(motions.begin() + count / 2);  // one step without odometry
  return motions;
}

}  // namespace

// The filter's own propagation is the reference: pose, calibration and their joint covariance.
TEST(MotionChain, IsWhatTheFilterPropagates) {
  EkfSlamParts parts = batch_parts(wheel_scales());
  const Eigen::Matrix3d cov_no_odometry = Eigen::Vector3d(0.1, 0.2, 0.05).cwiseAbs2().asDiagonal();
  parts.cov_no_odometry = cov_no_odometry;
  const auto motions = some_motions(6);
  MotionChain chain(*parts.motion, cov_no_odometry);
  chain.start(Eigen::Vector3d::Zero(), Eigen::Vector2d::Ones());
  EkfSlam filter(std::move(parts));
  for (const auto& motion : motions) {
    chain.append(motion);
    filter.propagate(motion ? &*motion : nullptr);
  }
  const GaussianState& state = filter.state();
  EXPECT_LT((chain.end() - state.estimate(filter.pose())).norm(), 1e-15);
  const Eigen::Matrix2d prior = state.full_covariance().bottomRightCorner<2, 2>();
  const Eigen::Matrix3d expected =
      chain.covariance() + chain.wrt_calibration() * prior * chain.wrt_calibration().transpose();
  EXPECT_LT((expected - state.covariance_of(filter.pose())).norm(), 1e-14);
}

TEST(MotionChain, DerivativesAreThoseOfTheEnd) {
  const EkfSlamParts parts = batch_parts(wheel_scales());
  const auto motions = some_motions(5);
  MotionChain chain(*parts.motion, Eigen::Matrix3d::Identity());
  Eigen::VectorXd x(5);
  x << 1.0, -2.0, 0.7, 1.03, 0.98;
  const auto end_of = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
    chain.start(at.head<3>(), at.tail<2>());
    for (const auto& motion : motions) chain.append(motion);
    return chain.end();
  };
  const Eigen::MatrixXd numeric = numeric_jacobian(x, end_of);
  end_of(x);
  EXPECT_LT((numeric.leftCols<3>() - chain.wrt_pose()).norm(), 1e-8);
  EXPECT_LT((numeric.rightCols<2>() - chain.wrt_calibration()).norm(), 1e-8);
}

TEST(MotionChain, WhiteningInvertsRegularNoiseAndHoldsWhatHasNone) {
  Eigen::Matrix3d cov;
  cov << 4.0, 1.0, 0.2, 1.0, 3.0, 0.1, 0.2, 0.1, 0.5;
  const Eigen::Matrix3d w = whitening_of(cov);
  EXPECT_LT((w * cov * w.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);

  const Eigen::Matrix3d flat = Eigen::Vector3d(0.04, 0.0, 0.01).asDiagonal();
  const Eigen::Matrix3d held = whitening_of(flat);
  EXPECT_NEAR((held * Eigen::Vector3d::UnitY()).norm(), 1.0 / (1e-3 * 0.2), 1e-6);
  EXPECT_NEAR((held * Eigen::Vector3d::UnitX()).norm(), 1.0 / 0.2, 1e-12);
  EXPECT_NEAR((whitening_of(Eigen::Matrix3d::Zero()) * Eigen::Vector3d::UnitX()).norm(), 1e5, 1e-6);
}

TEST(MotionChain, InterpolationKeepsAnUndisturbedPathAndSpreadsADeviation) {
  const EkfSlamParts parts = batch_parts(wheel_scales());
  const auto motions = some_motions(6);
  MotionChain chain(*parts.motion, 1e-6 * Eigen::Matrix3d::Identity());
  const Eigen::Vector3d from(0.5, 0.2, -0.3);
  const Eigen::Vector2d calibration(1.0, 1.0);
  chain.start(from, calibration);
  std::vector<Eigen::Vector3d> plain;
  for (const auto& motion : motions) {
    chain.append(motion);
    plain.push_back(chain.end());
  }
  const Eigen::Vector3d end = chain.end();
  const auto kept = interpolate(chain, from, end, calibration, motions);
  ASSERT_EQ(kept.size(), motions.size() - 1);
  for (std::size_t k = 0; k < kept.size(); ++k) EXPECT_LT((kept[k] - plain[k]).norm(), 1e-12);

  const auto pulled =
      interpolate(chain, from, end + Eigen::Vector3d(0.02, 0.0, 0.0), calibration, motions);
  double before = 0.0;
  for (std::size_t k = 0; k < pulled.size(); ++k) {
    const double moved = (pulled[k] - plain[k]).x();
    EXPECT_GE(moved, before - 1e-9);
    EXPECT_LT(moved, 0.02 + 1e-9);
    before = moved;
  }
  EXPECT_GT(before, 0.01);
}
