#pragma once
// The figures of metrics.hpp for paths in space. `truth.spatial` must be filled.

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <libslam/result/metrics.hpp>

namespace libslam {

/// Absolute errors. Raw under `T_truth_filter`, with drift; aligned by rigid least squares over all
/// matched positions. The rotation error is the angle between the true and the raw orientation.
PathErrors compare_path(std::span<const SpatialEstimate> estimate, const Trajectory& truth,
                        std::span<const PoseMatch> matches,
                        const std::optional<Eigen::Isometry3d>& T_truth_filter);

/// Relative errors with distances in space and angles of rotation; see compare_relative in the
/// plane.
std::optional<RelativeErrors> compare_relative(std::span<const SpatialEstimate> estimate,
                                               const Trajectory& truth,
                                               std::span<const PoseMatch> matches,
                                               double distance_m = 0.0);

/// NEES of every match with 6 degrees of freedom, in the additive chart of SE(3) blocks and the
/// filter's frame, to which the inverse of `T_truth_filter` carries the truth. NaN where the
/// covariance is singular. Needs a true orientation; throws std::invalid_argument without.
std::vector<double> pose_nees(std::span<const SpatialEstimate> estimate, const Trajectory& truth,
                              std::span<const PoseMatch> matches,
                              const Eigen::Isometry3d& T_truth_filter);

/// Positions of the matched poses: the estimated ones, the true ones (3 x n, [m]).
struct MatchedPoints {
  Eigen::Matrix3Xd estimate, truth;
};
MatchedPoints matched_points(std::span<const SpatialEstimate> estimate, const Trajectory& truth,
                             std::span<const PoseMatch> matches);

}  // namespace libslam
