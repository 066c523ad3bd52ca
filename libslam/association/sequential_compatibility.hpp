#pragma once
// Association one feature after the other, each on the condition of the pairs before it.
//
// The features come in the order of the observation, which a front-end chooses so that the most
// telling ones are first. What a pair adds to the joint squared Mahalanobis distance is its
// distance given the pairs taken so far, so that the first walls of a scan put the pose right
// before the short ones are looked at. The gates apply to that. Costs O(pairs^2), where the search
// of joint_compatibility.hpp is exponential in the worst case, and believes its first pairs.
// Source: Neira & Tardos, IEEE Trans. Robotics and Automation 17(6), 2001, section III (SCNN).

#include <libslam/association/associator.hpp>
#include <libslam/association/incremental_innovation.hpp>

namespace libslam {

/// A feature takes the landmark with the least d^2 + log |S| inside the gate that no feature before
/// it took; it is new if it is beyond the new-landmark gate of every landmark, otherwise
/// ambiguous.
class SequentialCompatibility final : public Associator {
 public:
  /// Squared Mahalanobis distances. Throws std::invalid_argument unless 0 < gate <=
  /// new_landmark_gate.
  SequentialCompatibility(double gate, double new_landmark_gate);
  void associate(std::span<const Feature> features, const LandmarkRegistry& registry,
                 Compatibility& compatibility, std::vector<Verdict>& verdicts) override;

 private:
  double gate_, new_landmark_gate_;
  std::vector<Pairing> pairs_;  // within the new-landmark gate, by feature
  std::vector<bool> taken_;     // landmarks
  IncrementalInnovation joint_;
};

}  // namespace libslam
