#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <mrpt/math/wrap2pi.h>

#include <libslam/result/alignment.hpp>

namespace libslam {
namespace {

using mrpt::math::TPose2D;

TPose2D to_pose(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

double median_step(const std::vector<double>& times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i)
    if (times[i] > times[i - 1]) steps.push_back(times[i] - times[i - 1]);
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

std::size_t nearest(const std::vector<double>& times, double time) {
  const auto after = std::lower_bound(times.begin(), times.end(), time);
  if (after == times.begin()) return 0;
  if (after == times.end()) return times.size() - 1;
  const auto index = static_cast<std::size_t>(after - times.begin());
  return *after - time < time - times[index - 1] ? index : index - 1;
}

std::vector<PoseMatch> match_by_time(std::span<const EstimatedPose> estimate,
                                     const std::vector<double>& times) {
  // A microsecond of slack: seconds since 1970 as a double resolve no better than 0.24 us.
  const double tolerance = 0.5 * median_step(times) + 1e-6;
  std::vector<PoseMatch> matches;
  const auto distance = [&](const PoseMatch& m) {
    return std::abs(estimate[m.estimate].time - times[m.truth]);
  };
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const PoseMatch match{i, nearest(times, estimate[i].time)};
    if (distance(match) > tolerance) continue;
    if (matches.empty() || matches.back().truth != match.truth)
      matches.push_back(match);
    else if (distance(match) < distance(matches.back()))
      matches.back() = match;
  }
  return matches;
}

std::vector<PoseMatch> match_by_order(std::span<const EstimatedPose> estimate, std::size_t truths) {
  const std::int64_t steps = estimate.back().step + 1;
  const std::int64_t offset = static_cast<std::int64_t>(truths) == steps + 1 ? 1 : 0;
  std::vector<PoseMatch> matches;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const std::int64_t row = estimate[i].step + offset;
    if (row >= 0 && row < static_cast<std::int64_t>(truths))
      matches.push_back({i, static_cast<std::size_t>(row)});
  }
  return matches;
}

}  // namespace

std::vector<PoseMatch> match_poses(std::span<const EstimatedPose> estimate,
                                   const Trajectory& truth) {
  if (estimate.empty() || truth.poses.empty()) return {};
  return truth.times.empty() ? match_by_order(estimate, truth.poses.size())
                             : match_by_time(estimate, truth.times);
}

TPose2D place_on(const Eigen::Vector3d& estimate, const Eigen::Vector3d& truth) {
  return to_pose(truth) + invert(to_pose(estimate));
}

std::optional<TPose2D> fit_rigid(const Eigen::Matrix2Xd& estimate, const Eigen::Matrix2Xd& truth) {
  if (estimate.cols() < 2) return std::nullopt;
  // Dynamic sizes: with two fixed rows GCC 12 warns falsely inside Eigen (stringop-overread).
  const Eigen::MatrixXd from = estimate, to = truth;
  const Eigen::Matrix3d T = Eigen::umeyama(from, to, false);
  return TPose2D(T(0, 2), T(1, 2), std::atan2(T(1, 0), T(0, 0)));
}

Eigen::Vector3d transform_pose(const TPose2D& T, const Eigen::Vector3d& pose) {
  const TPose2D moved = T + to_pose(pose);
  return {moved.x, moved.y, mrpt::math::wrapToPi(moved.phi)};
}

Eigen::Vector2d transform_point(const TPose2D& T, const Eigen::Vector2d& point) {
  return transform_pose(T, {point.x(), point.y(), 0.0}).head<2>();
}

std::vector<EstimatedPose> path_of_point(std::span<const EstimatedPose> robot,
                                         const Eigen::Vector2d& point) {
  std::vector<EstimatedPose> moved(robot.begin(), robot.end());
  for (EstimatedPose& step : moved)
    step.pose.head<2>() += Eigen::Rotation2Dd(step.pose.z()) * point;
  return moved;
}

TPose2D invert(const TPose2D& T) {
  return TPose2D(0, 0, 0) - T;
}

}  // namespace libslam
