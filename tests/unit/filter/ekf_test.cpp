#include <random>
#include <tests/support/random_matrix.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/filter/ekf.hpp>

using namespace libslam;
using libslam::testing::random_covariance;
using libslam::testing::random_matrix;

namespace {

const BlockSpec kVector3{"x", Chart::kVector, 3};

LinearizedMeasurement linear_measurement(BlockId block, const Eigen::MatrixXd& h,
                                         const Eigen::VectorXd& nu, const Eigen::MatrixXd& r) {
  LinearizedMeasurement measurement;
  measurement.innovation = nu;
  measurement.wrt.add(block, h.rows(), h.cols()) = h;
  measurement.cov = r;
  return measurement;
}

}  // namespace

TEST(Ekf, CorrectionIsTheKalmanFilterOnALinearProblem) {
  std::mt19937_64 random(51);
  for (const char* frame : {"standard", "right_invariant"}) {
    GaussianState state;
    const BlockId pose = state.add({"pose", Chart::kSE2, 3, WorldRole::kPose},
                                   Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero());
    const Eigen::VectorXd x0 = random_matrix(3, 1, random);
    const Eigen::MatrixXd p0 = random_covariance(3, random);
    const BlockId x = state.add(kVector3, x0, p0);
    const Eigen::MatrixXd h = random_matrix(2, 3, random), r = random_covariance(2, random);
    const Eigen::VectorXd nu = random_matrix(2, 1, random);
    Ekf ekf(make_error_frame(frame));
    const LinearizedMeasurement measurement = linear_measurement(x, h, nu, r);
    const Eigen::MatrixXd s = h * p0 * h.transpose() + r;
    const Innovation innovation = ekf.innovate(state, measurement);
    EXPECT_NEAR(innovation.mahalanobis2, nu.dot(s.inverse() * nu), 1e-12);
    EXPECT_NEAR(innovation.log_det, std::log(s.determinant()), 1e-12);
    const Correction correction = ekf.correct(state, pose, std::span(&measurement, 1));
    EXPECT_TRUE(correction.applied);
    EXPECT_NEAR(correction.nis, innovation.mahalanobis2, 1e-12);
    EXPECT_EQ(correction.dof, 2);
    const Eigen::MatrixXd k = p0 * h.transpose() * s.inverse();
    EXPECT_LT((state.estimate(x) - (x0 + k * nu)).norm(), 1e-13);
    EXPECT_LT((state.covariance_of(x) - (p0 - k * h * p0)).norm(), 1e-13);
  }
}

TEST(Ekf, JointAndSequentialCorrectionsAgreeOnALinearProblem) {
  std::mt19937_64 random(52);
  GaussianState joint;
  const BlockId pose = joint.add({"pose", Chart::kSE2, 3, WorldRole::kPose},
                                 Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero());
  const BlockId x = joint.add(kVector3, random_matrix(3, 1, random), random_covariance(3, random));
  GaussianState sequential = joint;
  const Eigen::VectorXd before = joint.estimate(x);
  Ekf ekf(make_error_frame("standard"));
  std::vector<LinearizedMeasurement> measurements;
  for (int i = 0; i < 3; ++i)
    measurements.push_back(linear_measurement(
        x, random_matrix(2, 3, random), random_matrix(2, 1, random), random_covariance(2, random)));
  ekf.correct(joint, pose, measurements);
  for (LinearizedMeasurement measurement : measurements) {
    // The innovation was taken at `before`; h is linear.
    measurement.innovation -= measurement.wrt.begin()->jacobian * (sequential.estimate(x) - before);
    ekf.correct(sequential, pose, std::span(&measurement, 1));
  }
  EXPECT_LT((joint.estimate(x) - sequential.estimate(x)).norm(), 1e-12);
  EXPECT_LT((joint.covariance_of(x) - sequential.covariance_of(x)).norm(), 1e-12);
}

TEST(Ekf, AnIndefiniteInnovationCovarianceLeavesTheStateAlone) {
  GaussianState state;
  const BlockId x = state.add(kVector3, Eigen::Vector3d(1, 2, 3), Eigen::Matrix3d::Identity());
  const LinearizedMeasurement bad =
      linear_measurement(x, Eigen::MatrixXd::Identity(1, 3), Eigen::VectorXd::Ones(1),
                         -5.0 * Eigen::MatrixXd::Ones(1, 1));
  Ekf ekf(make_error_frame("standard"));
  EXPECT_FALSE(ekf.correct(state, x, std::span(&bad, 1)).applied);
  EXPECT_TRUE(std::isinf(ekf.innovate(state, bad).mahalanobis2));
  EXPECT_EQ(state.estimate(x), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(state.covariance_of(x), Eigen::Matrix3d::Identity());
}

TEST(Ekf, NamesTheBlockWhoseJacobianDoesNotFit) {
  GaussianState state;
  const BlockId x = state.add(kVector3, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity());
  Ekf ekf(make_error_frame("standard"));
  const LinearizedMeasurement wrong = linear_measurement(
      x, Eigen::MatrixXd::Ones(2, 2), Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity());
  try {
    ekf.correct(state, x, std::span(&wrong, 1));
    FAIL() << "a 2 x 2 Jacobian of a block of size 3 must be refused";
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(), "Jacobian with respect to block 'x' is 2 x 2, expected 2 x 3");
  }
  MotionStep step;
  step.target = x;
  step.cov_noise = BlockMatrix::Identity(2, 2);
  EXPECT_THROW(ekf.propagate(state, step), std::invalid_argument);
}
