#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <mrpt/math/TPose2D.h>

#include <libslam/result/relations.hpp>

namespace libslam {
namespace {

constexpr double kSameTime = 1e-3;  ///< [s]; laser scans are tens of milliseconds apart

/// The last of the poses nearest to `time`, or null.
const EstimatedPose* pose_at(std::span<const EstimatedPose> path, double time) {
  const auto later = [](double t, const EstimatedPose& pose) { return t < pose.time; };
  const auto after = std::upper_bound(path.begin(), path.end(), time, later);
  const EstimatedPose* nearest = nullptr;
  double distance = kSameTime;
  if (after != path.begin() && time - std::prev(after)->time <= distance) {
    nearest = &*std::prev(after);
    distance = time - nearest->time;
  }
  if (after != path.end() && after->time - time < distance) {
    const auto end = std::upper_bound(after, path.end(), after->time, later);
    nearest = &*std::prev(end);
  }
  return nearest;
}

mrpt::math::TPose2D to_pose(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

/// Mean and standard deviation of values that are added one by one (Welford).
struct Spread {
  int count = 0;
  double mean = 0.0, squares = 0.0;

  void add(double value) {
    const double before = value - mean;
    mean += before / ++count;
    squares += before * (value - mean);
  }
  double deviation() const { return std::sqrt(squares / count); }
};

}  // namespace

std::optional<RelationErrors> compare_relations(std::span<const EstimatedPose> path,
                                                std::span<const PoseRelation> relations) {
  Spread translation, rotation;
  RelationErrors errors;
  for (const PoseRelation& relation : relations) {
    const EstimatedPose* from = pose_at(path, relation.from_time);
    const EstimatedPose* to = pose_at(path, relation.to_time);
    if (from == nullptr || to == nullptr) {
      ++errors.unmatched;
      continue;
    }
    const mrpt::math::TPose2D error =
        (to_pose(to->pose) - to_pose(from->pose)) - to_pose(relation.T_from_to);
    translation.add(error.norm());
    rotation.add(std::abs(std::remainder(error.phi, 2.0 * std::numbers::pi)) * 180.0 /
                 std::numbers::pi);
  }
  if (translation.count == 0) return std::nullopt;
  errors.matched = translation.count;
  errors.trans_mean_m = translation.mean;
  errors.trans_std_m = translation.deviation();
  errors.rot_mean_deg = rotation.mean;
  errors.rot_std_deg = rotation.deviation();
  return errors;
}

std::optional<RelationErrors> compare_relations(const Trajectory& path,
                                                std::span<const PoseRelation> relations) {
  std::vector<EstimatedPose> poses(path.times.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].time = path.times[i];
    poses[i].pose = path.poses[i];
  }
  return compare_relations(poses, relations);
}

}  // namespace libslam
