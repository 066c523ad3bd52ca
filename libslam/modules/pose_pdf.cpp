#include <Eigen/Dense>  // before any use of asEigen()

#include <libslam/modules/pose_pdf.hpp>
#include <libslam/modules/start_pose.hpp>

namespace libslam {

namespace {

using mrpt::poses::CPose3D;

/// d(rotation about the axes of the world) by yaw, pitch, roll, R <- Exp(d) R with
/// R = Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Matrix3d rotation_by_angles(double yaw, double pitch) {
  const Eigen::AngleAxisd turn(yaw, Eigen::Vector3d::UnitZ());
  Eigen::Matrix3d jacobian;
  jacobian.col(0) = Eigen::Vector3d::UnitZ();
  jacobian.col(1) = turn * Eigen::Vector3d::UnitY();
  jacobian.col(2) =
      turn * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) * Eigen::Vector3d::UnitX();
  return jacobian;
}

/// d(r, x, y, z) by a rotation about the axes of the world: q <- (1, d / 2) q.
Eigen::Matrix<double, 4, 3> quaternion_by_rotation(const Eigen::Quaterniond& q) {
  Eigen::Matrix<double, 4, 3> jacobian;
  jacobian << -q.x(), -q.y(), -q.z(),  //
      q.w(), q.z(), -q.y(),            //
      -q.z(), q.w(), q.x(),            //
      q.y(), -q.x(), q.w();
  return 0.5 * jacobian;
}

}  // namespace

mrpt::poses::CPose3DPDFGaussian to_pose_pdf(const StepRecord& record) {
  mrpt::poses::CPose3DPDFGaussian pdf;
  if (!record.spatial) {
    pdf.mean = CPose3D(record.pose[0], record.pose[1], 0.0, record.pose[2], 0.0, 0.0);
    constexpr int kPlanar[] = {0, 1, 3};  // of x, y, z, yaw, pitch, roll
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) pdf.cov(kPlanar[r], kPlanar[c]) = record.cov(r, c);
    return pdf;
  }
  const Eigen::Quaterniond q = record.spatial->pose.rotation;
  const Eigen::Vector3d& p = record.spatial->pose.position;
  pdf.mean =
      CPose3D(mrpt::math::CQuaternionDouble(q.w(), q.x(), q.y(), q.z()), p.x(), p.y(), p.z());
  Eigen::Matrix<double, 6, 6> jacobian = Eigen::Matrix<double, 6, 6>::Identity();
  jacobian.bottomRightCorner<3, 3>() =
      rotation_by_angles(pdf.mean.yaw(), pdf.mean.pitch()).inverse();
  pdf.cov.asEigen() = jacobian * record.spatial->cov * jacobian.transpose();
  return pdf;
}

mrpt::poses::CPose3DQuatPDFGaussian to_quaternion_pdf(const StepRecord& record) {
  const SpatialEstimate estimate = spatial_estimate(record);
  const Eigen::Quaterniond& q = estimate.pose.rotation;
  const Eigen::Vector3d& p = estimate.pose.position;
  mrpt::poses::CPose3DQuatPDFGaussian pdf;
  pdf.mean = mrpt::poses::CPose3DQuat(p.x(), p.y(), p.z(),
                                      mrpt::math::CQuaternionDouble(q.w(), q.x(), q.y(), q.z()));
  Eigen::Matrix<double, 7, 6> jacobian = Eigen::Matrix<double, 7, 6>::Zero();
  jacobian.topLeftCorner<3, 3>().setIdentity();
  jacobian.bottomRightCorner<4, 3>() = quaternion_by_rotation(q);
  pdf.cov.asEigen() = jacobian * estimate.cov * jacobian.transpose();
  return pdf;
}

SpatialEstimate from_pose_pdf(const mrpt::poses::CPose3DPDF& pose) {
  mrpt::poses::CPose3DPDFGaussian pdf;
  pdf.copyFrom(pose);
  const mrpt::math::CQuaternionDouble q = mrpt::poses::CPose3DQuat(pdf.mean).quat();
  SpatialEstimate estimate;
  estimate.pose.position = {pdf.mean.x(), pdf.mean.y(), pdf.mean.z()};
  estimate.pose.rotation = Eigen::Quaterniond(q.r(), q.x(), q.y(), q.z());
  Eigen::Matrix<double, 6, 6> jacobian = Eigen::Matrix<double, 6, 6>::Identity();
  jacobian.bottomRightCorner<3, 3>() = rotation_by_angles(pdf.mean.yaw(), pdf.mean.pitch());
  estimate.cov = jacobian * pdf.cov.asEigen() * jacobian.transpose();
  return estimate;
}

}  // namespace libslam
