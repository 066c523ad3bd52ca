#include <libslam/association/nearest_neighbour.hpp>

#include <algorithm>
#include <stdexcept>
#include <tuple>

namespace libslam {

NearestNeighbour::NearestNeighbour(double gate, double new_landmark_gate)
    : gate_(gate), new_landmark_gate_(new_landmark_gate) {
  if (!(gate > 0.0 && gate <= new_landmark_gate))
    throw std::invalid_argument(
        "the association gate must be positive and not beyond the new-landmark gate");
}

void NearestNeighbour::associate(std::span<const Feature> features,
                                 const LandmarkRegistry& registry, Compatibility& compatibility,
                                 std::vector<Verdict>& verdicts) {
  verdicts.assign(features.size(), {Outcome::kNew, 0});
  pairs_.clear();
  for (std::size_t i = 0; i < features.size(); ++i)
    for (std::size_t k = 0; k < registry.size(); ++k) {
      const auto match = compatibility.test(i, k, new_landmark_gate_);
      if (!match || match->mahalanobis2 > new_landmark_gate_) continue;
      verdicts[i].outcome = Outcome::kAmbiguous;
      if (match->mahalanobis2 <= gate_) pairs_.push_back({match->mahalanobis2 + match->log_det, i, k});
    }
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.cost, a.feature, a.landmark) < std::tie(b.cost, b.feature, b.landmark);
  });
  taken_.assign(registry.size(), false);
  for (const Pair& pair : pairs_) {
    if (verdicts[pair.feature].outcome == Outcome::kPaired || taken_[pair.landmark]) continue;
    verdicts[pair.feature] = {Outcome::kPaired, pair.landmark};
    taken_[pair.landmark] = true;
  }
}

}  // namespace libslam
