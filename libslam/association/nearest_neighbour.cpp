#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include <libslam/association/nearest_neighbour.hpp>

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
      if (match->mahalanobis2 <= gate_)
        pairs_.push_back({match->mahalanobis2 + match->log_det, i, k});
    }
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.cost, a.feature, a.landmark) < std::tie(b.cost, b.feature, b.landmark);
  });
  taken_.assign(registry.size(), false);
  dropped_.assign(features.size(), false);
  settle_contests();
  for (const Pair& pair : pairs_) {
    if (verdicts[pair.feature].outcome == Outcome::kPaired || dropped_[pair.feature] ||
        taken_[pair.landmark])
      continue;
    verdicts[pair.feature] = {Outcome::kPaired, pair.landmark};
    taken_[pair.landmark] = true;
  }
}

void NearestNeighbour::settle_contests() {
  static const double kMargin = 2.0 * std::log(kLikelihoodRatio);
  first_claim_.assign(taken_.size(), nullptr);
  claimed_.assign(dropped_.size(), false);
  for (const Pair& pair : pairs_) {
    if (claimed_[pair.feature]) continue;  // not its best landmark
    claimed_[pair.feature] = true;
    const Pair*& first = first_claim_[pair.landmark];
    if (first == nullptr) {
      first = &pair;
    } else if (pair.cost - first->cost < kMargin) {
      dropped_[first->feature] = dropped_[pair.feature] = true;
      taken_[pair.landmark] = true;
    }
  }
}

}  // namespace libslam
