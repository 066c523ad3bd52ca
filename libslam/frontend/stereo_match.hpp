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

}  // namespace libslam
