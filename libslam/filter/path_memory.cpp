#include <cmath>
#include <set>
#include <utility>

#include <libslam/filter/path_memory.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

namespace {

constexpr double kPlaceSpacing = 0.7;    // [m]
constexpr double kPlaceTurn = 0.5;       // [rad]
constexpr double kStretchLength = 10.0;  // [m]
constexpr double kReach = 12.0;          // farther points turn too much with the heading [m]

}  // namespace

Eigen::Vector3d SeenPlace::T_world_place(const GaussianState& state) const {
  return compose_poses(state.estimate(kept), T_kept_place);
}

bool PathMemory::remember(const GaussianState& state, BlockId pose, BlockId kept,
                          std::span<const Eigen::Vector2d> points) {
  const Eigen::Vector3d T_world_robot = state.estimate(pose);
  double way = 0.0;
  if (!places_.empty()) way = places_.back().way;
  if (first_ < places_.size()) {
    const Eigen::Vector3d moved = relative_pose(places_.back().T_world_place(state), T_world_robot);
    const double distance = moved.head<2>().norm();
    if (distance < kPlaceSpacing && std::abs(moved.z()) < kPlaceTurn) return false;
    way += distance;
  }
  SeenPlace& place = places_.emplace_back();
  place.kept = kept;
  place.T_kept_place = relative_pose(state.estimate(kept), T_world_robot);
  place.way = way;
  for (const Eigen::Vector2d& p : points)
    if (p.norm() <= kReach) place.points.push_back(p);
  if (way - places_[open_].way >= kStretchLength) {
    stretches_.push_back({open_, places_.size()});
    const double half = places_[open_].way + 0.5 * kStretchLength;
    while (places_[open_].way < half) ++open_;
  }
  return true;
}

PathStretch PathMemory::recent(double length) const {
  std::size_t first = places_.size();
  while (first > first_ && places_.back().way - places_[first - 1].way <= length) --first;
  return {first, places_.size()};
}

std::vector<SurfaceScan> PathMemory::scans(const GaussianState& state, const PathStretch& stretch,
                                           std::size_t frame) const {
  const Eigen::Vector3d T_world_frame = places_[frame].T_world_place(state);
  std::vector<SurfaceScan> scans;
  for (std::size_t i = stretch.first; i < stretch.last; ++i) {
    const Eigen::Vector3d T_frame_place =
        relative_pose(T_world_frame, places_[i].T_world_place(state));
    SurfaceScan& scan = scans.emplace_back();
    scan.origin = T_frame_place.head<2>();
    scan.points.reserve(places_[i].points.size());
    for (const Eigen::Vector2d& p : places_[i].points)
      scan.points.push_back(transform_point(T_frame_place, p));
  }
  return scans;
}

std::vector<Eigen::Vector2d> thinned_points(std::span<const SurfaceScan> scans, double spacing) {
  std::set<std::pair<long, long>> taken;
  std::vector<Eigen::Vector2d> points;
  for (const SurfaceScan& scan : scans)
    for (const Eigen::Vector2d& p : scan.points)
      if (taken.emplace(std::lround(p.x() / spacing), std::lround(p.y() / spacing)).second)
        points.push_back(p);
  return points;
}

}  // namespace libslam
