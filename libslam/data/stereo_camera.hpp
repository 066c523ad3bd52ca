#pragma once
// A calibrated, rectified stereo pair on a robot.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace libslam {

/// Pinhole model of both cameras after rectification. The camera frame is that of the left camera:
/// X right, Y down, Z along the optical axis. A point (X, Y, Z) is seen at
///     u = cx + fx X / Z,   v = cy + fy Y / Z,   d = u_left - u_right = fx baseline / Z.
struct StereoCamera {
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  ///< [px]
  double baseline = 0.0;                          ///< [m], > 0
  int width = 0, height = 0;                      ///< [px], 0 if unknown
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
};

/// (u, v, d) [px] of a point in front of the camera, in the camera frame [m].
inline Eigen::Vector3d project(const StereoCamera& camera, const Eigen::Vector3d& p_camera) {
  const double depth = p_camera.z();
  return {camera.cx + camera.fx * (p_camera.x() / depth),
          camera.cy + camera.fy * (p_camera.y() / depth), camera.fx * camera.baseline / depth};
}

/// d project / d p_camera [px/m].
inline Eigen::Matrix3d projection_jacobian(const StereoCamera& camera,
                                           const Eigen::Vector3d& p_camera) {
  const double depth = p_camera.z();
  Eigen::Matrix3d J;
  J << camera.fx, 0.0, -camera.fx * (p_camera.x() / depth), 0.0, camera.fy,
      -camera.fy * (p_camera.y() / depth), 0.0, 0.0, -camera.fx * camera.baseline / depth;
  return J / depth;
}

/// Position in the camera frame [m] of z = (u, v, d), d > 0.
inline Eigen::Vector3d triangulate(const StereoCamera& camera, const Eigen::Vector3d& z) {
  const double depth = camera.fx * camera.baseline / z[2];
  return {(z[0] - camera.cx) / camera.fx * depth, (z[1] - camera.cy) / camera.fy * depth, depth};
}

/// d triangulate / d z [m/px], where p_camera = triangulate(z) and d the disparity.
inline Eigen::Matrix3d triangulation_jacobian(const StereoCamera& camera,
                                              const Eigen::Vector3d& p_camera, double d) {
  const double depth = p_camera.z();
  Eigen::Matrix3d J;
  J << depth / camera.fx, 0.0, -p_camera.x() / d, 0.0, depth / camera.fy, -p_camera.y() / d, 0.0,
      0.0, -depth / d;
  return J;
}

}  // namespace libslam
