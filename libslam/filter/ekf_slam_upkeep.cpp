// What EkfSlam does with its map and its past after an observation.

#include <libslam/filter/ekf_slam.hpp>

namespace libslam {

std::optional<Extent> EkfSlam::sighted_part(BlockId landmark, const Feature& feature) const {
  return parts_.measurement->sighted_part(state_, pose_, landmark, feature);
}

void EkfSlam::keep_up() {
  const PhaseTimer timer(times_, Phase::kUpdate);
  if (landmarks_given_ || disturbed()) return;
  if (parts_.merging)
    parts_.merging->update(state_, ekf_, pose_, *parts_.measurement, parts_.registry);
  if (parts_.building_prior) parts_.building_prior->apply(state_, ekf_, pose_, parts_.registry);
}

void EkfSlam::remember_pose(double time) {
  if (!parts_.delayed) return;
  const PhaseTimer timer(times_, Phase::kAugment);
  parts_.delayed->remember(state_, pose_, time);
}

bool EkfSlam::look_for_loops(std::span<const Eigen::Vector2d> points) {
  if (!parts_.loop_closure || !parts_.delayed || points.empty()) return false;
  if (landmarks_given_ || disturbed()) return false;
  const PhaseTimer timer(times_, Phase::kUpdate);
  const std::optional<BlockId> kept = parts_.delayed->latest();
  if (!kept) return false;
  if (!parts_.loop_closure->look(state_, ekf_, pose_, *kept, points)) return false;
  if (parts_.merging)
    parts_.merging->merge_all(state_, ekf_, pose_, *parts_.measurement, parts_.registry);
  return true;
}

std::optional<Trajectory> EkfSlam::smoothed_path() const {
  if (!parts_.delayed) return std::nullopt;
  return parts_.delayed->path(state_);
}

}  // namespace libslam
