#include <algorithm>
#include <limits>
#include <stdexcept>
#include <tuple>

#include <libslam/association/appearance.hpp>

namespace libslam {

AppearanceAssociation::AppearanceAssociation(double gate, double max_distance, double ratio)
    : gate_(gate), max_distance_(max_distance), ratio_(ratio) {
  if (!(gate > 0.0) || !(max_distance > 0.0 && max_distance <= 1.0) ||
      !(ratio > 0.0 && ratio <= 1.0))
    throw std::invalid_argument(
        "association by appearance needs a positive gate, and a distance and a ratio in (0, 1]");
}

void AppearanceAssociation::associate(std::span<const Feature> features,
                                      const LandmarkRegistry& registry,
                                      Compatibility& compatibility,
                                      std::vector<Verdict>& verdicts) {
  verdicts.assign(features.size(), {});
  claims_.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (!features[i].appearance) continue;
    const Outcome outcome = look_up(i, *features[i].appearance, registry);
    if (outcome == Outcome::kNew) verdicts[i].outcome = Outcome::kNew;
  }
  std::sort(claims_.begin(), claims_.end(), [](const Claim& a, const Claim& b) {
    return std::tie(a.distance, a.feature) < std::tie(b.distance, b.feature);
  });
  taken_.assign(registry.size(), false);
  for (const Claim& claim : claims_) {
    if (taken_[claim.landmark]) continue;  // stays ambiguous
    const auto match = compatibility.test(claim.feature, claim.landmark, gate_);
    const bool fits = match && match->mahalanobis2 <= gate_;
    verdicts[claim.feature] = {fits ? Outcome::kPaired : Outcome::kGated, claim.landmark};
    taken_[claim.landmark] = fits;
  }
}

Outcome AppearanceAssociation::look_up(std::size_t feature, const Descriptor& appearance,
                                       const LandmarkRegistry& registry) {
  double best = std::numeric_limits<double>::infinity(), second = best;
  std::size_t landmark = 0;
  const auto landmarks = registry.landmarks();
  for (std::size_t k = 0; k < landmarks.size(); ++k) {
    if (!landmarks[k].appearance) continue;
    const double distance = relative_distance(appearance, *landmarks[k].appearance);
    if (distance < best) {
      second = best;
      best = distance;
      landmark = k;
    } else {
      second = std::min(second, distance);
    }
  }
  if (!(best <= max_distance_)) return Outcome::kNew;
  if (best > ratio_ * second) return Outcome::kAmbiguous;
  claims_.push_back({best, feature, landmark});
  return Outcome::kPaired;
}

}  // namespace libslam
