#pragma once
// A calibrated, rectified stereo pair on a robot.

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

}  // namespace libslam
