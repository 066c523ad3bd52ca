#pragma once
// Rotations in space by their rotation vector theta (axis times angle [rad]).
//
//   Exp(theta) = I + sin t / t [theta] + a [theta]^2,   V(theta) = I + a [theta] + b [theta]^2
//   a = (1 - cos t) / t^2,  b = (t - sin t) / t^3,  t = |theta|,  [.] the cross product matrix
//
// V is the left Jacobian: Exp(theta + d) = Exp(V d) Exp(theta) to first order, and Exp of a twist
// (theta, rho) in SE(3) has the translation V rho. Source: Barfoot, State Estimation for Robotics,
// 2017, section 7.1. Every function is accurate to rounding at and near theta = 0.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace libslam {

/// [v] with [v] w = v x w.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Quaterniond so3_exp(const Eigen::Vector3d& theta);
/// Rotation vector of a unit quaternion, |theta| <= pi.
Eigen::Vector3d so3_log(Eigen::Quaterniond q);
/// V(theta).
Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& theta);
/// d (V(theta) u) / d theta.
Eigen::Matrix3d so3_left_jacobian_derivative(const Eigen::Vector3d& theta,
                                             const Eigen::Vector3d& u);

}  // namespace libslam
