#include <limits>

#include <libslam/filter/landmark_merging.hpp>

namespace libslam {

int LandmarkMerging::update(GaussianState& state, Ekf& ekf, BlockId pose,
                            const MeasurementModel& model, LandmarkRegistry& registry) {
  if (++updates_ % options_.every != 0) return 0;
  return pass(state, ekf, pose, model, registry, options_.every);
}

int LandmarkMerging::merge_all(GaussianState& state, Ekf& ekf, BlockId pose,
                               const MeasurementModel& model, LandmarkRegistry& registry) {
  return pass(state, ekf, pose, model, registry, std::numeric_limits<int>::max());
}

int LandmarkMerging::pass(GaussianState& state, Ekf& ekf, BlockId pose,
                          const MeasurementModel& model, LandmarkRegistry& registry,
                          int most_unseen) {
  const int before = merged_;
  std::size_t i = 0;
  while (i < registry.size()) {
    bool changed = false;
    if (registry.landmarks()[i].unseen <= most_unseen)
      for (std::size_t k = 0; k < registry.size() && !changed; ++k)
        changed = k != i && merge(state, ekf, pose, model, registry, i, k);
    // After a merge landmarks have moved up, and the one that is left may fit another.
    i = changed ? 0 : i + 1;
  }
  return merged_ - before;
}

bool LandmarkMerging::merge(GaussianState& state, Ekf& ekf, BlockId pose,
                            const MeasurementModel& model, LandmarkRegistry& registry,
                            std::size_t first, std::size_t second) {
  const RegisteredLandmark &a = registry.landmarks()[first], &b = registry.landmarks()[second];
  if (!a.extent || !b.extent) return false;
  const LandmarkPart part_a{a.block, *a.extent}, part_b{b.block, *b.extent};
  if (!model.difference(state, part_a, part_b, options_.extent_gap, difference_)) return false;
  if (ekf.innovate(state, difference_).mahalanobis2 > options_.gate) return false;
  if (!ekf.correct(state, pose, {&difference_, 1}).applied) return false;
  const bool keeps_first = a.times_seen >= b.times_seen;
  const std::size_t kept = keeps_first ? first : second, gone = keeps_first ? second : first;
  const LandmarkPart other = keeps_first ? part_b : part_a;
  state.remove(
      registry.merge(kept, gone, model.part_along(state, registry.landmarks()[kept].block, other)));
  ++merged_;
  return true;
}

}  // namespace libslam
