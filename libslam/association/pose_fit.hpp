#pragma once
// A planar pose from paired points, by least squares.
//
//   e = m - (R q + t),   S = cov(m) + R cov(q) R^T,   minimize sum e^T S^-1 e over t and phi

#include <span>

#include <Eigen/Core>

#include <libslam/association/constellation_index.hpp>

namespace libslam {

/// A point in the robot frame and the point of the map that it is.
struct PointPair {
  const PlanarPoint* seen;
  const PlanarPoint* landmark;
};

struct PoseFit {
  Eigen::Vector3d T_world_robot;  ///< x [m], y [m], phi [rad]
  Eigen::Matrix3d cov;            ///< of the additive error of the pose
  double mahalanobis2 = 0.0;      ///< sum e^T S^-1 e
  double log_likelihood = 0.0;    ///< sum log N(e; 0, S)
};

/// R of a pose.
Eigen::Matrix2d rotation_of(const Eigen::Vector3d& pose);

/// e and S of a pair at a pose.
struct PointResidual {
  PointResidual(const PlanarPoint& seen, const PlanarPoint& landmark, const Eigen::Vector3d& pose,
                const Eigen::Matrix2d& rotation);
  Eigen::Vector2d e;
  Eigen::Matrix2d s;
  double mahalanobis2() const;
};

/// Gauss-Newton from a pose that is right within about 20 degrees. At least two pairs with
/// different points, else the covariance is not finite.
PoseFit fit_pose(std::span<const PointPair> pairs, const Eigen::Vector3d& start);

/// The same where the errors of the landmarks go together: `cov_landmarks` (2n x 2n, in the order
/// of the pairs) instead of theirs. What all have in common, the drift of a map, is no misfit then
/// and hides none: the distance measures what they have not. Infinite distance where S is not
/// positive definite.
PoseFit fit_pose(std::span<const PointPair> pairs, const Eigen::MatrixXd& cov_landmarks,
                 const Eigen::Vector3d& start);

}  // namespace libslam
