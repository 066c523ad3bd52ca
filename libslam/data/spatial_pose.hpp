#pragma once
// A pose in space and an estimate of one.

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace libslam {

/// T_world_body: position [m] and orientation (unit quaternion, world from body).
struct SpatialPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  Eigen::Isometry3d isometry() const { return Eigen::Translation3d(position) * rotation; }
};

/// Covariance in the additive chart of SE(3) blocks (state/block.hpp): position [m], then rotation
/// vector in the world frame [rad].
struct SpatialEstimate {
  SpatialPose pose;
  Eigen::Matrix<double, 6, 6> cov = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Shadow of a pose on the ground: x [m], y [m], yaw [rad] (z-y-x convention).
inline Eigen::Vector3d shadow_of(const SpatialPose& pose) {
  const Eigen::Vector3d forward = pose.rotation * Eigen::Vector3d::UnitX();
  return {pose.position.x(), pose.position.y(), std::atan2(forward.y(), forward.x())};
}

/// Covariance of the shadow to first order, of (x, y, yaw). Yaw means nothing where the body looks
/// straight up or down; its row is then that of the rotation about z.
inline Eigen::Matrix3d shadow_covariance(const SpatialEstimate& estimate) {
  const Eigen::Vector3d forward = estimate.pose.rotation * Eigen::Vector3d::UnitX();
  const double level = forward.head<2>().squaredNorm();
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  J.topLeftCorner<2, 2>().setIdentity();
  if (level > 1e-12) J.block<1, 2>(2, 3) = -forward.z() / level * forward.head<2>().transpose();
  J(2, 5) = 1.0;
  return J * estimate.cov * J.transpose();
}

}  // namespace libslam
