#pragma once
// How the frames of an estimated and a true path in space lie to each other.

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <libslam/data/trajectory.hpp>

namespace libslam {

/// T_truth_estimate that lays the estimated pose on the true one.
Eigen::Isometry3d place_on(const SpatialPose& estimate, const SpatialPose& truth);

/// T_truth_estimate, least squares without scale, of corresponding columns (3 x n, [m]); nothing
/// with fewer than three points. Where all points lie on a line any turn about it fits as well.
/// Umeyama, PAMI 1991.
std::optional<Eigen::Isometry3d> fit_rigid_in_space(const Eigen::Matrix3Xd& estimate,
                                                    const Eigen::Matrix3Xd& truth);

SpatialPose transform_pose(const Eigen::Isometry3d& T, const SpatialPose& pose);

/// a [-] b in the additive chart of SE(3) blocks (state/block.hpp): position [m], then rotation
/// vector in the world frame [rad].
Eigen::Matrix<double, 6, 1> pose_difference(const SpatialPose& a, const SpatialPose& b);

/// The path of a point fixed on the robot (x forward, y left [m]); orientations and covariances
/// stay the robot's.
std::vector<SpatialEstimate> path_of_point(std::span<const SpatialEstimate> robot,
                                           const Eigen::Vector2d& point);

/// The path in space of a path in the plane: at height 0, without roll and pitch.
std::vector<SpatialPose> lift_to_space(std::span<const Eigen::Vector3d> poses);

}  // namespace libslam
