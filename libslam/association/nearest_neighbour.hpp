#pragma once
// Association by distance, one-to-one, with a dead zone between "sighting" and "new".

#include <libslam/association/associator.hpp>

namespace libslam {

/// Pairs inside the gate are ranked by d^2 + log |S| (the maximum-likelihood order) and taken greedily,
/// each feature and landmark once. A feature that stays alone is new only if it is beyond the
/// new-landmark gate of every landmark, otherwise ambiguous.
class NearestNeighbour final : public Associator {
 public:
  /// Squared Mahalanobis distances. Throws std::invalid_argument unless 0 < gate <= new_landmark_gate.
  NearestNeighbour(double gate, double new_landmark_gate);
  void associate(std::span<const Feature> features, const LandmarkRegistry& registry,
                 Compatibility& compatibility, std::vector<Verdict>& verdicts) override;

 private:
  struct Pair {
    double cost;
    std::size_t feature, landmark;
  };
  double gate_, new_landmark_gate_;
  std::vector<Pair> pairs_;
  std::vector<bool> taken_;
};

}  // namespace libslam
