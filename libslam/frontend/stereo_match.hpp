#pragma once
// A point seen by both cameras of a rectified pair.

#include <cmath>
#include <memory>

#include <Eigen/Core>

#include <libslam/data/descriptor.hpp>
#include <libslam/data/stereo_camera.hpp>

namespace libslam {

/// z = (u, v, d) [px] as in StereoCamera, v the mean of both rows. With independent noise `sigma`
/// of the columns and rows in both images, and `place`, by which both images show another point
/// than the sighting before,
///     cov z = sigma^2 [1 0 1; 0 1/2 0; 1 0 2] + place^2 diag(1, 1, 0),
/// since d = u - u_right shares u.
struct StereoMatch {
  Eigen::Vector3d z = Eigen::Vector3d::Zero();
  double sigma = 1.0;                            ///< [px]
  double place = 0.0;                            ///< [px]
  double row_error = 0.0;                        ///< v_left - v_right [px]: shows a bad calibration
  std::shared_ptr<const Descriptor> appearance;  ///< may be null
};

inline Eigen::Matrix3d covariance_of(const StereoMatch& point) {
  Eigen::Matrix3d shape;
  shape << 1.0, 0.0, 1.0, 0.0, 0.5, 0.0, 1.0, 0.0, 2.0;
  const Eigen::Vector3d place(1.0, 1.0, 0.0);
  Eigen::Matrix3d cov = point.sigma * point.sigma * shape;
  cov.diagonal() += point.place * point.place * place;
  return cov;
}

/// Its disparity is positive and known to a third: nearer to infinity the depth means nothing.
inline bool has_depth(const StereoMatch& point) {
  const double sigma_d = std::sqrt(2.0) * point.sigma;
  return point.z[2] > 0.0 && point.z[2] >= 3.0 * sigma_d;
}

/// Position in the camera frame [m] of z = (u, v, d), d > 0.
inline Eigen::Vector3d triangulate(const StereoCamera& camera, const Eigen::Vector3d& z) {
  const double depth = camera.fx * camera.baseline / z[2];
  return {(z[0] - camera.cx) / camera.fx * depth, (z[1] - camera.cy) / camera.fy * depth, depth};
}

/// (u, v, d) of a point in front of the camera.
inline Eigen::Vector3d project(const StereoCamera& camera, const Eigen::Vector3d& p_camera) {
  return {camera.cx + camera.fx * p_camera.x() / p_camera.z(),
          camera.cy + camera.fy * p_camera.y() / p_camera.z(),
          camera.fx * camera.baseline / p_camera.z()};
}

}  // namespace libslam
