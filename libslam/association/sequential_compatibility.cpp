#include <limits>
#include <stdexcept>

#include <libslam/association/sequential_compatibility.hpp>

namespace libslam {

SequentialCompatibility::SequentialCompatibility(double gate, double new_landmark_gate)
    : gate_(gate), new_landmark_gate_(new_landmark_gate) {
  if (!(gate > 0.0 && gate <= new_landmark_gate))
    throw std::invalid_argument(
        "the association gate must be positive and not beyond the new-landmark gate");
}

void SequentialCompatibility::associate(std::span<const Feature> features,
                                        const LandmarkRegistry& registry,
                                        Compatibility& compatibility,
                                        std::vector<Verdict>& verdicts) {
  verdicts.assign(features.size(), {Outcome::kNew, 0});
  pairs_.clear();
  for (std::size_t i = 0; i < features.size(); ++i)
    for (std::size_t k = 0; k < registry.size(); ++k) {
      const auto match = compatibility.test(i, k, new_landmark_gate_);
      if (match && match->mahalanobis2 <= new_landmark_gate_) pairs_.push_back({i, k});
    }
  compatibility.select(pairs_);
  joint_.reset(compatibility);
  taken_.assign(registry.size(), false);
  for (std::size_t pair = 0; pair < pairs_.size();) {
    const std::size_t feature = pairs_[pair].feature;
    Verdict& verdict = verdicts[feature];
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = pairs_.size();
    for (; pair < pairs_.size() && pairs_[pair].feature == feature; ++pair) {
      const Match added = joint_.extend(pair);
      if (added.mahalanobis2 <= new_landmark_gate_) verdict.outcome = Outcome::kAmbiguous;
      const double cost = added.mahalanobis2 + added.log_det;
      if (added.mahalanobis2 > gate_ || taken_[pairs_[pair].landmark] || cost >= least) continue;
      least = cost;
      best = pair;
    }
    if (best == pairs_.size()) continue;
    joint_.extend(best);
    joint_.push();
    taken_[pairs_[best].landmark] = true;
    verdict = {Outcome::kPaired, pairs_[best].landmark};
  }
  joint_.clear();
}

}  // namespace libslam
