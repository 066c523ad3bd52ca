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
  int forget_after = 0;

  void describe(auto& v) {
    v.value("method", method,
            {"",
             "known: identities of the log; nearest_neighbour: identities are ignored; "
             "known_or_nearest: identities of the log without a gate, nearest neighbour for "
             "observations that have none.",
             0,
             0,
             {"known", "nearest_neighbour", "known_or_nearest"}});
    v.value("gate_probability", gate_probability,
            {"1",
             "An observation is accepted as a sighting of a landmark if its squared Mahalanobis "
             "distance is below this chi-square probability; 1 accepts all.",
             0, 1});
    v.value(
        "new_landmark_probability", new_landmark_probability,
        {"1",
         "An observation starts a new landmark only if it is beyond this chi-square probability of "
         "every landmark; in between it is dropped as ambiguous (nearest_neighbour).",
         0, 1});
    v.value("confirm_after", confirm_after,
            {"1", "Sightings after which a landmark counts as confirmed.", 1});
    v.value("prune_after", prune_after,
            {"1", "A landmark that is not confirmed within this many updates is removed; 0: never.",
             0});
    v.value(
        "forget_after", forget_after,
        {"1",
         "Any landmark that is not seen in so many updates in a row is removed, a confirmed one "
         "too; 0: never. For odometry from tracked points, whose identities never come back.",
         0});
  }
};

}  // namespace libslam
