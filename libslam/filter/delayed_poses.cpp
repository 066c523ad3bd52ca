#include <cmath>
#include <stdexcept>

#include <libslam/filter/delayed_poses.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

DelayedPoses::DelayedPoses(const DelayedPoseSpacing& spacing) : spacing_(spacing) {
  if (!(spacing.distance > 0.0) || !(spacing.turn > 0.0))
    throw std::invalid_argument("delayed poses need a positive distance and turn, got " +
                                std::to_string(spacing.distance) + " m, " +
                                std::to_string(spacing.turn) + " rad");
}

void DelayedPoses::remember(GaussianState& state, BlockId pose, double time) {
  if (state.spec(pose).chart != Chart::kSE2)
    throw std::invalid_argument("block '" + state.spec(pose).name +
                                "': poses of the past are kept in the plane alone");
  if (restarted_) {
    if (!segments_.empty()) segments_.back().joined = false;
    restarted_ = false;
    keep(state, pose);
  }
  const Eigen::Vector3d step = relative_pose(state.estimate(blocks_.back()), state.estimate(pose));
  steps_.push_back({time, step});
  if (step.head<2>().norm() >= spacing_.distance || std::abs(step.z()) >= spacing_.turn)
    keep(state, pose);
}

void DelayedPoses::keep(GaussianState& state, BlockId pose) {
  blocks_.push_back(state.clone(pose, "pose_" + std::to_string(blocks_.size())));
  segments_.push_back({steps_.size(), true});
}

void DelayedPoses::append_segment(const GaussianState& state, std::size_t segment,
                                  Trajectory& path) const {
  const bool last = segment + 1 == segments_.size();
  const std::size_t begin = segments_[segment].first_step;
  const std::size_t end = last ? steps_.size() : segments_[segment + 1].first_step;
  if (begin == end) return;
  const Eigen::Vector3d T_world_kept = state.estimate(blocks_[segment]);
  Eigen::Vector3d misclosure = Eigen::Vector3d::Zero();
  if (!last && segments_[segment].joined) {
    const Eigen::Vector3d next = state.estimate(blocks_[segment + 1]);
    misclosure = next - compose_poses(T_world_kept, steps_[end - 1].T_kept_robot);
    misclosure.z() = wrap_angle(misclosure.z());
  }
  for (std::size_t i = begin; i < end; ++i) {
    const double fraction = static_cast<double>(i + 1 - begin) / static_cast<double>(end - begin);
    Eigen::Vector3d pose =
        compose_poses(T_world_kept, steps_[i].T_kept_robot) + fraction * misclosure;
    pose.z() = wrap_angle(pose.z());
    path.times.push_back(steps_[i].time);
    path.poses.push_back(pose);
  }
}

Trajectory DelayedPoses::path(const GaussianState& state) const {
  Trajectory path;
  path.times.reserve(steps_.size());
  path.poses.reserve(steps_.size());
  for (std::size_t segment = 0; segment < segments_.size(); ++segment)
    append_segment(state, segment, path);
  return path;
}

}  // namespace libslam
