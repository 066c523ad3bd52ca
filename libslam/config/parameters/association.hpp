#pragma once
// Data association.

#include <string>

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `association`.
struct AssociationParameters {
  std::string method = "known";
  double gate_probability = 0.99;
  double new_landmark_probability = 0.999;
  int confirm_after = 1;
  int prune_after = 0;

  /// False: the identities of the log are not even looked at.
  bool uses_identities() const {
    return method != "nearest_neighbour" && method != "joint_compatibility";
  }

  void describe(auto& v) {
    v.value("method", method,
            {"",
             "known: identities of the log; nearest_neighbour: identities are ignored; "
             "joint_compatibility: likewise, and the observations of a frame are paired together "
             "(JCBB), which holds with a pose that is off by more than landmarks are apart; "
             "known_or_nearest, known_or_joint: identities of the log without a gate, one of the "
             "two for observations that have none.",
             0,
             0,
             {"known", "nearest_neighbour", "joint_compatibility", "known_or_nearest",
              "known_or_joint"}});
    v.value("gate_probability", gate_probability,
            {"1",
             "An observation is accepted as a sighting of a landmark if its squared Mahalanobis "
             "distance is below this chi-square probability; 1 accepts all.",
             0, 1});
    v.value(
        "new_landmark_probability", new_landmark_probability,
        {"1",
         "An observation starts a new landmark only if it is beyond this chi-square probability of "
         "every landmark; in between it is dropped as ambiguous (all methods but known).",
         0, 1});
    v.value("confirm_after", confirm_after,
            {"1", "Sightings after which a landmark counts as confirmed.", 1});
    v.value("prune_after", prune_after,
            {"1", "A landmark that is not confirmed within this many updates is removed; 0: never.",
             0});
  }
};

}  // namespace libslam
