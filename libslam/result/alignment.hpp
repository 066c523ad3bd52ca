#pragma once
// Which estimated pose belongs to which true one, and how the two frames lie to each other.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <mrpt/math/TPose2D.h>

#include <libslam/data/trajectory.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam {

/// Indices into the estimated and the true path.
struct PoseMatch {
  std::size_t estimate, truth;
};

/// Pairs in time order. With times: each estimate with the nearest true pose, within half the
/// median sampling step of the truth; of several estimates with the same true pose the nearest one
/// stays. Without times: step i with true pose i, or with i + 1 where the truth has exactly one
/// pose more than the run has steps (the start pose before the first motion).
std::vector<PoseMatch> match_poses(std::span<const EstimatedPose> estimate,
                                   const Trajectory& truth);

/// T_truth_estimate that lays the estimated pose on the true one.
mrpt::math::TPose2D place_on(const Eigen::Vector3d& estimate, const Eigen::Vector3d& truth);

/// T_truth_estimate, least squares without scale, of corresponding columns (2 x n, [m]); nothing
/// with fewer than two points. Umeyama, PAMI 1991.
std::optional<mrpt::math::TPose2D> fit_rigid(const Eigen::Matrix2Xd& estimate,
                                             const Eigen::Matrix2Xd& truth);

/// A o b for poses (x, y, phi); the heading is wrapped to (-pi, pi].
Eigen::Vector3d transform_pose(const mrpt::math::TPose2D& T, const Eigen::Vector3d& pose);
Eigen::Vector2d transform_point(const mrpt::math::TPose2D& T, const Eigen::Vector2d& point);

/// The path of a point fixed on the robot (x forward, y left [m]); headings and covariances stay
/// the robot's.
std::vector<EstimatedPose> path_of_point(std::span<const EstimatedPose> robot,
                                         const Eigen::Vector2d& point);

/// The inverse transformation.
mrpt::math::TPose2D invert(const mrpt::math::TPose2D& T);

}  // namespace libslam
