#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/config/parameters.hpp>
#include <libslam/modules/pose_pdf.hpp>

#include "support/random_matrix.hpp"

namespace libslam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

SpatialPose displaced(const SpatialPose& pose, const Eigen::Matrix<double, 6, 1>& d) {
  SpatialPose moved;
  moved.position = pose.position + d.head<3>();
  const double angle = d.tail<3>().norm();
  moved.rotation = pose.rotation;
  if (angle > 0.0) moved.rotation = Eigen::AngleAxisd(angle, d.tail<3>() / angle) * pose.rotation;
  return moved;
}

StepRecord record_of(const SpatialPose& pose, const Matrix6& cov = Matrix6::Zero()) {
  StepRecord record;
  record.spatial = SpatialEstimate{pose, cov};
  return record;
}

Eigen::Matrix<double, 6, 1> angles_of(const SpatialPose& pose) {
  const mrpt::poses::CPose3D mean = to_pose_pdf(record_of(pose)).mean;
  Eigen::Matrix<double, 6, 1> values;
  values << mean.x(), mean.y(), mean.z(), mean.yaw(), mean.pitch(), mean.roll();
  return values;
}

Eigen::Matrix<double, 7, 1> quaternion_of(const SpatialPose& pose) {
  const mrpt::poses::CPose3DQuat mean = to_quaternion_pdf(record_of(pose)).mean;
  Eigen::Matrix<double, 7, 1> values;
  for (int i = 0; i < 7; ++i) values[i] = mean[static_cast<unsigned>(i)];
  return values;
}

/// J P J^T with J by central differences.
template <typename Function>
Eigen::MatrixXd carried(const SpatialPose& pose, const Matrix6& cov, Function function) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd jacobian(function(pose).size(), 6);
  for (int i = 0; i < 6; ++i) {
    const Eigen::Matrix<double, 6, 1> d = kStep * Eigen::Matrix<double, 6, 1>::Unit(i);
    jacobian.col(i) =
        (function(displaced(pose, d)) - function(displaced(pose, -d))) / (2.0 * kStep);
  }
  return jacobian * cov * jacobian.transpose();
}

TEST(PosePdf, CarriesTheCovarianceOfAPoseInSpace) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    SpatialPose pose;
    const double pitch = 1.3 * uniform(random);  // away from the singular +-pi/2
    const double scale = trial == 0 ? 0.0 : (trial == 1 ? 1e-8 : 1.0);
    pose.position =
        10.0 * scale * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
    pose.rotation = Eigen::AngleAxisd(3.0 * scale * uniform(random), Eigen::Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(scale * pitch, Eigen::Vector3d::UnitY()) *
                    Eigen::AngleAxisd(3.0 * scale * uniform(random), Eigen::Vector3d::UnitX());
    if (pose.rotation.w() < 0.0) pose.rotation.coeffs() *= -1.0;  // as MRPT keeps it
    const Eigen::MatrixXd root =
        Eigen::MatrixXd::NullaryExpr(6, 6, [&] { return uniform(random); });
    const Matrix6 cov = root * root.transpose();
    const auto record = record_of(pose, cov);
    // Differences of step 1e-6 are good to about 1e-9 of the entries, which reach some tens here.
    EXPECT_LT((to_pose_pdf(record).cov.asEigen() - carried(pose, cov, angles_of)).norm(), 1e-5);
    EXPECT_LT((to_quaternion_pdf(record).cov.asEigen() - carried(pose, cov, quaternion_of)).norm(),
              1e-6);
  }
}

TEST(PosePdf, LaysAPlanarPoseOnTheGround) {
  StepRecord record;
  record.pose = {1.0, -2.0, kPi - 0.1};
  record.cov << 4.0, 1.0, 0.3, 1.0, 3.0, 0.2, 0.3, 0.2, 0.5;
  const auto pdf = to_pose_pdf(record);
  EXPECT_EQ(pdf.mean.x(), 1.0);
  EXPECT_EQ(pdf.mean.z(), 0.0);
  EXPECT_NEAR(pdf.mean.yaw(), kPi - 0.1, 1e-15);
  EXPECT_EQ(pdf.cov(3, 3), 0.5);
  EXPECT_EQ(pdf.cov(0, 3), 0.3);
  EXPECT_EQ(pdf.cov(2, 2), 0.0);
  EXPECT_EQ(pdf.cov(5, 5), 0.0);
  // By way of the quaternion MRPT comes to the same.
  const mrpt::poses::CPose3DPDFGaussian back(to_quaternion_pdf(record));
  EXPECT_LT((back.cov.asEigen() - pdf.cov.asEigen()).norm(), 1e-9);
  EXPECT_NEAR(back.mean.yaw(), pdf.mean.yaw(), 1e-12);
}

}  // namespace
}  // namespace libslam
