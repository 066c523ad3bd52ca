#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Dense>
#include <mrpt/math/wrap2pi.h>

#include <libslam/result/metrics.hpp>
#include <libslam/result/normalized_error.hpp>
#include <libslam/result/run_axis.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {
namespace {

using mrpt::math::TPose2D;
using mrpt::math::wrapToPi;

Eigen::Matrix2Xd positions(std::span<const PoseMatch> matches, auto&& pose_of) {
  Eigen::Matrix2Xd points(2, static_cast<Eigen::Index>(matches.size()));
  for (std::size_t i = 0; i < matches.size(); ++i)
    points.col(static_cast<Eigen::Index>(i)) = pose_of(matches[i]).template head<2>();
  return points;
}

PathErrors::Position position_errors(const TPose2D& T, const Eigen::Matrix2Xd& estimate,
                                     const Eigen::Matrix2Xd& truth) {
  PathErrors::Position errors;
  const auto n = static_cast<double>(truth.cols());
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  for (Eigen::Index i = 0; i < truth.cols(); ++i) {
    const Eigen::Vector2d e = transform_point(T, estimate.col(i)) - truth.col(i);
    squares += e.cwiseAbs2();
    errors.mean_m += e.norm() / n;
    errors.max_m = std::max(errors.max_m, e.norm());
  }
  errors.rmse_x_m = std::sqrt(squares.x() / n);
  errors.rmse_y_m = std::sqrt(squares.y() / n);
  errors.rmse_m = std::sqrt(squares.sum() / n);
  return errors;
}

std::vector<double> cumulative_length(const Trajectory& truth, std::span<const PoseMatch> matches) {
  std::vector<double> length(matches.size(), 0.0);
  for (std::size_t i = 1; i < matches.size(); ++i)
    length[i] =
        length[i - 1] +
        (truth.poses[matches[i].truth] - truth.poses[matches[i - 1].truth]).head<2>().norm();
  return length;
}

/// a^-1 o b.
Eigen::Vector3d between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return transform_pose(invert({a.x(), a.y(), a.z()}), b);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace

PathErrors compare_path(std::span<const EstimatedPose> estimate, const Trajectory& truth,
                        std::span<const PoseMatch> matches,
                        const std::optional<TPose2D>& T_truth_filter) {
  PathErrors errors;
  errors.poses = static_cast<int>(matches.size());
  if (matches.empty()) return errors;
  const auto points =
      positions(matches, [&](const PoseMatch& m) { return estimate[m.estimate].pose; });
  const auto true_points =
      positions(matches, [&](const PoseMatch& m) { return truth.poses[m.truth]; });
  if (const auto fit = fit_rigid(points, true_points))
    errors.aligned = position_errors(*fit, points, true_points);
  if (!truth.has_heading && !T_truth_filter) return errors;

  const TPose2D T = T_truth_filter ? *T_truth_filter
                                   : place_on(estimate[matches.front().estimate].pose,
                                              truth.poses[matches.front().truth]);
  errors.raw = position_errors(T, points, true_points);
  if (!truth.has_heading) return errors;
  errors.heading.emplace();
  double squares = 0.0;
  for (const PoseMatch& m : matches) {
    const double e = wrapToPi(estimate[m.estimate].pose.z() + T.phi - truth.poses[m.truth].z());
    squares += e * e;
    errors.heading->max_rad = std::max(errors.heading->max_rad, std::abs(e));
  }
  errors.heading->rmse_rad = std::sqrt(squares / errors.poses);
  return errors;
}

std::optional<RelativeErrors> compare_relative(std::span<const EstimatedPose> estimate,
                                               const Trajectory& truth,
                                               std::span<const PoseMatch> matches,
                                               double distance_m) {
  if (!truth.has_heading || matches.size() < 2) return std::nullopt;
  const auto error = [&](std::size_t i, std::size_t j) -> RelativePoseError {
    const PoseMatch &from = matches[i], &to = matches[j];
    const Eigen::Vector3d moved = between(estimate[from.estimate].pose, estimate[to.estimate].pose);
    const Eigen::Vector3d moved_truly = between(truth.poses[from.truth], truth.poses[to.truth]);
    const Eigen::Vector3d difference = between(moved_truly, moved);
    return {difference.head<2>().norm(), std::abs(difference.z())};
  };
  return average_over_stretches(cumulative_length(truth, matches), distance_m, error);
}

std::vector<double> pose_nees(std::span<const EstimatedPose> estimate, const Trajectory& truth,
                              std::span<const PoseMatch> matches,
                              const std::optional<TPose2D>& T_truth_filter) {
  if (!truth.has_heading) throw std::invalid_argument("pose NEES needs a true heading");
  std::vector<double> values;
  if (matches.empty()) return values;
  values.reserve(matches.size());
  const TPose2D T_filter_truth =
      invert(T_truth_filter ? *T_truth_filter
                            : place_on(estimate[matches.front().estimate].pose,
                                       truth.poses[matches.front().truth]));
  for (const PoseMatch& m : matches) {
    Eigen::Vector3d e =
        estimate[m.estimate].pose - transform_pose(T_filter_truth, truth.poses[m.truth]);
    e.z() = wrapToPi(e.z());
    values.push_back(normalized_square<3>(e, estimate[m.estimate].cov));
  }
  return values;
}

std::optional<NeesSummary> summarize_nees(std::span<const EstimatedPose> estimate,
                                          std::span<const PoseMatch> matches,
                                          std::span<const double> values, int dof) {
  if (matches.empty()) return std::nullopt;
  const double lower = chi_square_quantile(0.025, dof), upper = chi_square_quantile(0.975, dof);
  const double ellipsoid = chi_square_quantile(0.95, dof);
  const RunAxis axis(estimate);
  const double begin = axis.at(estimate[matches.front().estimate]);
  const double span = axis.at(estimate[matches.back().estimate]) - begin;
  std::array<double, 4> sums{};
  std::array<int, 4> counts{};
  std::vector<double> finite;
  NeesSummary summary;
  summary.dof = dof;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    const double part = span > 0.0 ? (axis.at(estimate[matches[i].estimate]) - begin) / span : 0.0;
    const auto quarter = std::min<std::size_t>(3, static_cast<std::size_t>(4.0 * part));
    sums[quarter] += values[i];
    ++counts[quarter];
    finite.push_back(values[i]);
    summary.in_95 += values[i] >= lower && values[i] <= upper;
    summary.coverage_95 += values[i] <= ellipsoid;
  }
  if (finite.empty()) return std::nullopt;
  summary.steps = static_cast<int>(finite.size());
  summary.in_95 /= summary.steps;
  summary.coverage_95 /= summary.steps;
  summary.mean = (sums[0] + sums[1] + sums[2] + sums[3]) / summary.steps;
  summary.median = median(std::move(finite));
  for (std::size_t q = 0; q < 4; ++q)
    if (counts[q] > 0) summary.quarter_mean[q] = sums[q] / counts[q];
  return summary;
}

}  // namespace libslam
