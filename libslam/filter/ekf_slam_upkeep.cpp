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

}  // namespace libslam
