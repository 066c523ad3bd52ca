#pragma once
// Poses (x [m], y [m], phi [rad]) in the plane, composed. Headings are wrapped to (-pi, pi].
// Degrees stand in parameters alone.

#include <cmath>
#include <numbers>

#include <Eigen/Core>

#include <libslam/state/block.hpp>

namespace libslam {

inline double to_radians(double degrees) {
  return degrees * (std::numbers::pi / 180.0);
}

/// A point of frame b in frame a.
inline Eigen::Vector2d transform_point(const Eigen::Vector3d& T_a_b, const Eigen::Vector2d& p_b) {
  const double c = std::cos(T_a_b.z()), s = std::sin(T_a_b.z());
  return {T_a_b.x() + c * p_b.x() - s * p_b.y(), T_a_b.y() + s * p_b.x() + c * p_b.y()};
}

/// A point of frame a in frame b.
inline Eigen::Vector2d transform_back(const Eigen::Vector3d& T_a_b, const Eigen::Vector2d& p_a) {
  const double c = std::cos(T_a_b.z()), s = std::sin(T_a_b.z());
  const Eigen::Vector2d d = p_a - T_a_b.head<2>();
  return {c * d.x() + s * d.y(), c * d.y() - s * d.x()};
}

/// T_a_c.
inline Eigen::Vector3d compose_poses(const Eigen::Vector3d& T_a_b, const Eigen::Vector3d& T_b_c) {
  const Eigen::Vector2d p = transform_point(T_a_b, T_b_c.head<2>());
  return {p.x(), p.y(), wrap_angle(T_a_b.z() + T_b_c.z())};
}

/// T_b_c from T_a_b and T_a_c.
inline Eigen::Vector3d relative_pose(const Eigen::Vector3d& T_a_b, const Eigen::Vector3d& T_a_c) {
  const Eigen::Vector2d p = transform_back(T_a_b, T_a_c.head<2>());
  return {p.x(), p.y(), wrap_angle(T_a_c.z() - T_a_b.z())};
}

}  // namespace libslam
