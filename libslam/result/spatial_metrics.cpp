#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Dense>

#include <libslam/result/normalized_error.hpp>
#include <libslam/result/spatial_alignment.hpp>
#include <libslam/result/spatial_metrics.hpp>

namespace libslam {
namespace {

using Eigen::Isometry3d;

PositionErrors position_errors(const Isometry3d& T, const MatchedPoints& points) {
  PositionErrors errors;
  const auto n = static_cast<double>(points.truth.cols());
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < points.truth.cols(); ++i) {
    const Eigen::Vector3d e = T * points.estimate.col(i) - points.truth.col(i);
    squares += e.cwiseAbs2();
    errors.mean_m += e.norm() / n;
    errors.max_m = std::max(errors.max_m, e.norm());
  }
  const Eigen::Vector3d by_axis = (squares / n).cwiseSqrt();
  errors.rmse_x_m = by_axis.x();
  errors.rmse_y_m = by_axis.y();
  errors.rmse_z_m = by_axis.z();
  errors.rmse_m = by_axis.norm();
  return errors;
}

std::vector<double> cumulative_length(const Trajectory& truth, std::span<const PoseMatch> matches) {
  std::vector<double> length(matches.size(), 0.0);
  for (std::size_t i = 1; i < matches.size(); ++i)
    length[i] = length[i - 1] + (truth.spatial[matches[i].truth].position -
                                 truth.spatial[matches[i - 1].truth].position)
                                    .norm();
  return length;
}

/// Angle [rad] of the rotation from `a` to `b`.
double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return pose_difference({Eigen::Vector3d::Zero(), b}, {Eigen::Vector3d::Zero(), a}).norm();
}

}  // namespace

MatchedPoints matched_points(std::span<const SpatialEstimate> estimate, const Trajectory& truth,
                             std::span<const PoseMatch> matches) {
  const auto n = static_cast<Eigen::Index>(matches.size());
  MatchedPoints points{Eigen::Matrix3Xd(3, n), Eigen::Matrix3Xd(3, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const PoseMatch& match = matches[static_cast<std::size_t>(i)];
    points.estimate.col(i) = estimate[match.estimate].pose.position;
    points.truth.col(i) = truth.spatial[match.truth].position;
  }
  return points;
}

PathErrors compare_path(std::span<const SpatialEstimate> estimate, const Trajectory& truth,
                        std::span<const PoseMatch> matches,
                        const std::optional<Isometry3d>& T_truth_filter) {
  PathErrors errors;
  errors.poses = static_cast<int>(matches.size());
  if (matches.empty()) return errors;
  const MatchedPoints points = matched_points(estimate, truth, matches);
  if (const auto fit = fit_rigid_in_space(points.estimate, points.truth))
    errors.aligned = position_errors(*fit, points);
  if (!T_truth_filter) return errors;
  errors.raw = position_errors(*T_truth_filter, points);
  const double length = cumulative_length(truth, matches).back();
  const Eigen::Index last = points.truth.cols() - 1;
  if (length > 0.0)
    errors.drift_percent =
        100.0 * (*T_truth_filter * points.estimate.col(last) - points.truth.col(last)).norm() /
        length;
  if (!truth.has_heading) return errors;
  errors.rotation.emplace();
  const Eigen::Quaterniond turn(T_truth_filter->linear());
  double squares = 0.0;
  for (const PoseMatch& m : matches) {
    const double angle =
        angle_between(turn * estimate[m.estimate].pose.rotation, truth.spatial[m.truth].rotation);
    squares += angle * angle;
    errors.rotation->max_rad = std::max(errors.rotation->max_rad, angle);
  }
  errors.rotation->rmse_rad = std::sqrt(squares / errors.poses);
  return errors;
}

std::optional<RelativeErrors> compare_relative(std::span<const SpatialEstimate> estimate,
                                               const Trajectory& truth,
                                               std::span<const PoseMatch> matches,
                                               double distance_m) {
  if (!truth.has_heading || matches.size() < 2) return std::nullopt;
  const auto error = [&](std::size_t i, std::size_t j) -> RelativePoseError {
    const PoseMatch &from = matches[i], &to = matches[j];
    const Isometry3d moved =
        estimate[from.estimate].pose.isometry().inverse() * estimate[to.estimate].pose.isometry();
    const Isometry3d moved_truly =
        truth.spatial[from.truth].isometry().inverse() * truth.spatial[to.truth].isometry();
    const Isometry3d difference = moved_truly.inverse() * moved;
    return {difference.translation().norm(),
            angle_between(Eigen::Quaterniond::Identity(), Eigen::Quaterniond(difference.linear()))};
  };
  return average_over_stretches(cumulative_length(truth, matches), distance_m, error);
}

std::vector<double> pose_nees(std::span<const SpatialEstimate> estimate, const Trajectory& truth,
                              std::span<const PoseMatch> matches,
                              const Isometry3d& T_truth_filter) {
  if (!truth.has_heading) throw std::invalid_argument("pose NEES needs a true orientation");
  const Isometry3d T_filter_truth = T_truth_filter.inverse();
  std::vector<double> values;
  values.reserve(matches.size());
  for (const PoseMatch& m : matches) {
    const SpatialEstimate& own = estimate[m.estimate];
    values.push_back(normalized_square<6>(
        pose_difference(own.pose, transform_pose(T_filter_truth, truth.spatial[m.truth])),
        own.cov));
  }
  return values;
}

}  // namespace libslam
