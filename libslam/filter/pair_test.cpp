#include <cmath>

#include <libslam/filter/pair_test.hpp>

namespace libslam {

std::optional<Match> PairTest::test(std::size_t feature, std::size_t landmark, double limit) {
  const BlockId block = parts_.registry.landmarks()[landmark].block;
  const bool bounded = std::isfinite(limit) && parts_.measurement.bounded_in_map();
  if (bounded && far_apart(feature, block, limit)) return std::nullopt;
  parts_.linearizer.linearize(parts_.measurement, parts_.state, parts_.pose, block,
                              features_[feature], measurement_);
  if (!measurement_.innovation.allFinite()) return std::nullopt;
  if (apart_along(feature, parts_.registry.landmarks()[landmark])) return std::nullopt;
  const Innovation innovation = parts_.ekf.innovate(parts_.state, measurement_);
  return Match{innovation.mahalanobis2, innovation.log_det};
}

void PairTest::select(std::span<const Pairing> pairs) {
  parts_.selected.clear();
  for (const auto& [feature, landmark] : pairs) {
    parts_.linearizer.linearize(parts_.measurement, parts_.state, parts_.pose,
                                parts_.registry.landmarks()[landmark].block, features_[feature],
                                measurement_);
    parts_.selected.add(measurement_);
  }
  parts_.selected.finish(parts_.state);
}

/// Two parts of one straight line that lie apart are two walls.
bool PairTest::apart_along(std::size_t feature, const RegisteredLandmark& landmark) const {
  if (!landmark.extent) return false;
  const auto part = parts_.measurement.sighted_part(parts_.state, parts_.pose, landmark.block,
                                                    features_[feature]);
  return part && part->gap_to(*landmark.extent) > parts_.extent_gap;
}

// In landmark space e = l_feature - l_map has covariance C <= 2 (C_feature + C_map), whatever
// their correlation, and e^T C^-1 e >= |e|^2 / trace(C).
bool PairTest::far_apart(std::size_t feature, BlockId landmark, double limit) {
  const GaussianState& state = parts_.state;
  if (feature != prepared_) {
    parts_.measurement.initialize(state, parts_.pose, features_[feature], where_);
    trace_ = where_.cov_noise.trace();
    for (const auto& [block, jacobian] : where_.wrt) {
      const BlockMatrix spread = jacobian * state.covariance_of(block);
      trace_ += spread.cwiseProduct(jacobian).sum();
    }
    prepared_ = feature;
  }
  const double distance2 = (where_.estimate - state.estimate(landmark)).squaredNorm();
  return distance2 > limit * 2.0 * (trace_ + state.covariance_of(landmark).trace());
}

}  // namespace libslam
