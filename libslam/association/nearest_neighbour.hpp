#pragma once
// Association by distance, one-to-one, with a dead zone between "sighting" and "new".

#include <libslam/association/associator.hpp>

namespace libslam {

/// Pairs inside the gate are ranked by d^2 + log |S| (the maximum-likelihood order) and taken
/// greedily, each feature and landmark once. Two features that both fit one landmark best are two
/// objects, one of them not in the map: unless the likelihood of the better is `kLikelihoodRatio`
/// times that of the other, neither is used. A feature that stays alone is new only if it is beyond
/// the new-landmark gate of every landmark, otherwise ambiguous.
class NearestNeighbour final : public Associator {
 public:
  /// One wrong decision in twenty at even odds.
  static constexpr double kLikelihoodRatio = 20.0;

  /// Squared Mahalanobis distances. Throws std::invalid_argument unless 0 < gate <=
  /// new_landmark_gate.
  NearestNeighbour(double gate, double new_landmark_gate);
  void associate(std::span<const Feature> features, const LandmarkRegistry& registry,
                 Compatibility& compatibility, std::vector<Verdict>& verdicts) override;

 private:
  struct Pair {
    double cost;
    std::size_t feature, landmark;
  };
  /// Marks landmarks that two features claim with similar likelihood, and drops these features.
  void settle_contests();

  double gate_, new_landmark_gate_;
  std::vector<Pair> pairs_;               // inside the gate, best first
  std::vector<bool> taken_;               // landmarks
  std::vector<bool> dropped_;             // features of an undecided contest
  std::vector<bool> claimed_;             // features whose best landmark is known
  std::vector<const Pair*> first_claim_;  // best claim on each landmark
};

}  // namespace libslam
