#include <algorithm>

#include <Eigen/Dense>

#include <libslam/result/run_axis.hpp>
#include <libslam/result/spatial_alignment.hpp>
#include <libslam/result/spatial_metrics.hpp>
#include <libslam/result/truth_comparison.hpp>

namespace libslam {
namespace {

using Matches = std::vector<PoseMatch>;

Matches matches_within(const RunWindow& window, std::span<const EstimatedPose> path,
                       Matches matches) {
  if (path.empty()) return matches;
  const double start = path.front().time;
  std::erase_if(matches, [&](const PoseMatch& m) {
    const EstimatedPose& pose = path[m.estimate];
    const double time = pose.time - start;
    return pose.step < window.first_step || pose.step > window.last_step || time < window.from_s ||
           time > window.to_s;
  });
  return matches;
}

std::optional<mrpt::math::TPose2D> fit_path(std::span<const EstimatedPose> path,
                                            const Trajectory& truth, const Matches& matches) {
  const auto n = static_cast<Eigen::Index>(matches.size());
  Eigen::Matrix2Xd from(2, n), to(2, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PoseMatch& match = matches[static_cast<std::size_t>(i)];
    from.col(i) = path[match.estimate].pose.head<2>();
    to.col(i) = truth.poses[match.truth].head<2>();
  }
  return fit_rigid(from, to);
}

std::optional<mrpt::math::TPose2D> raw_placement(std::span<const EstimatedPose> path,
                                                 const Trajectory& truth, const Matches& matches,
                                                 Placement placement) {
  if (placement == Placement::none) return mrpt::math::TPose2D(0.0, 0.0, 0.0);
  if (matches.empty() || !truth.has_heading) return std::nullopt;
  return place_on(path[matches.front().estimate].pose, truth.poses[matches.front().truth]);
}

void compare_in_plane(std::span<const EstimatedPose> robot, const LandmarkMap& map,
                      const GroundTruth& truth, LandmarkIdentity identity,
                      const ComparisonRules& rules, TruthComparison& result) {
  const std::vector<EstimatedPose> path = path_of_point(robot, truth.path.point_on_robot);
  const Matches all = match_poses(path, truth.path);
  const auto raw = raw_placement(path, truth.path, all, rules.placement);
  if (const Matches matches = matches_within(rules.window, path, all); !matches.empty()) {
    result.path = compare_path(path, truth.path, matches, raw);
    result.relative = compare_relative(path, truth.path, matches);
    if (truth.path.has_heading)
      result.nees = summarize_nees(path, matches, pose_nees(path, truth.path, matches, raw));
  }
  result.placement = raw ? raw : fit_path(path, truth.path, all);
  if (!truth.landmarks.empty())
    result.map = compare_map(map, truth.landmarks, identity, result.placement, raw.has_value());
}

void compare_in_space(const PathView& robot, const LandmarkMap& map, const GroundTruth& truth,
                      LandmarkIdentity identity, const ComparisonRules& rules,
                      TruthComparison& result) {
  const Trajectory true_path = comparable_truth(robot, truth.path);
  const auto path = path_of_point(robot.spatial, true_path.point_on_robot);
  const Matches all = match_poses(robot.poses, true_path);
  std::optional<Eigen::Isometry3d> raw;
  if (rules.placement == Placement::none)
    raw = Eigen::Isometry3d::Identity();
  else if (!all.empty() && true_path.has_heading)
    raw = place_on(path[all.front().estimate].pose, true_path.spatial[all.front().truth]);
  if (const Matches matches = matches_within(rules.window, robot.poses, all); !matches.empty()) {
    result.path = compare_path(path, true_path, matches, raw);
    result.relative = compare_relative(path, true_path, matches);
    if (true_path.has_heading)
      result.nees =
          summarize_nees(robot.poses, matches, pose_nees(path, true_path, matches, *raw), 6);
  }
  result.spatial_placement = raw;
  if (!raw) {
    const MatchedPoints points = matched_points(path, true_path, all);
    result.spatial_placement = fit_rigid_in_space(points.estimate, points.truth);
  }
  if (!truth.landmarks.empty())
    result.map = compare_map_in_space(map, truth.landmarks, identity, result.spatial_placement,
                                      raw.has_value());
}

/// The poses of `path`, each with the number of its step: the next of `steps` that has its time.
/// Many steps of a log may have the same time.
std::vector<EstimatedPose> numbered_poses(const Trajectory& path,
                                          std::span<const EstimatedPose> steps) {
  constexpr double kSameTime = 1e-6;
  std::vector<EstimatedPose> poses(path.times.size());
  for (std::size_t i = 0, k = 0; i < poses.size(); ++i) {
    while (k + 1 < steps.size() && steps[k].time < path.times[i] - kSameTime) ++k;
    poses[i].step = steps.empty() ? 0 : steps[k].step;
    if (k + 1 < steps.size()) ++k;
    poses[i].time = path.times[i];
    poses[i].pose = path.poses[i];
  }
  return poses;
}

bool is_compared_in_space(const PathView& estimate, const Trajectory& truth) {
  return !estimate.spatial.empty() &&
         (truth.poses.empty() || !truth.spatial.empty() || truth.has_heading);
}

}  // namespace

std::map<std::string, double> calibration_means(const std::vector<CalibrationValue>& calibration) {
  std::map<std::string, double> means;
  for (const CalibrationValue& value : calibration) means[value.name] = value.mean;
  return means;
}

Trajectory comparable_truth(const PathView& estimate, const Trajectory& truth) {
  Trajectory comparable = truth;
  if (!is_compared_in_space(estimate, truth))
    comparable.spatial.clear();
  else if (truth.spatial.empty())
    comparable.spatial = lift_to_space(truth.poses);
  return comparable;
}

void compare_smoothed(const Trajectory& smoothed, std::span<const EstimatedPose> estimate,
                      const GroundTruth& truth, const ComparisonRules& rules,
                      TruthComparison& comparison) {
  const std::vector<EstimatedPose> robot = numbered_poses(smoothed, estimate);
  comparison.relations_smoothed = compare_relations(robot, truth.relations);
  const std::vector<EstimatedPose> path = path_of_point(robot, truth.path.point_on_robot);
  const Matches all = match_poses(path, truth.path);
  if (const Matches matches = matches_within(rules.window, path, all); !matches.empty())
    comparison.path_smoothed = compare_path(path, truth.path, matches,
                                            raw_placement(path, truth.path, all, rules.placement));
}

TruthComparison compare_with_truth(const PathView& estimate, const LandmarkMap& map,
                                   const std::map<std::string, double>& calibration,
                                   const GroundTruth& truth, LandmarkIdentity identity,
                                   const ComparisonRules& rules) {
  TruthComparison result;
  if (is_compared_in_space(estimate, truth.path))
    compare_in_space(estimate, map, truth, identity, rules, result);
  else
    compare_in_plane(estimate.poses, map, truth, identity, rules, result);
  result.relations = compare_relations(estimate.poses, truth.relations);
  for (const auto& [name, value] : calibration)
    if (const auto found = truth.calibration.find(name); found != truth.calibration.end())
      result.calibration_error[name] = value - found->second;
  return result;
}

}  // namespace libslam
