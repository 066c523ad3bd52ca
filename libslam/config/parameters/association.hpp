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
  double extent_gap = 0.6;
  int merge_every = 0;
  double merge_probability = 0.99;
  double appearance_distance = 0.3;
  double appearance_ratio = 0.8;

  /// False: the identities of the log are not even looked at.
  bool uses_identities() const {
    return method != "nearest_neighbour" && method != "joint_compatibility" &&
           method != "sequential_compatibility" && method != "appearance";
  }

  void describe(auto& v) {
    v.value("method", method,
            {"",
             "known: identities of the log; nearest_neighbour: identities are ignored; "
             "joint_compatibility: likewise, and the observations of a frame are paired together "
             "(JCBB), which holds with a pose that is off by more than landmarks are apart; "
             "sequential_compatibility: likewise, one after the other in the order of the "
             "front-end, each given those before it; "
             "known_or_nearest, known_or_joint: identities of the log without a gate, one of the "
             "two for observations that have none; appearance: image features by their "
             "descriptors, then by the gate.",
             0,
             0,
             {"known", "nearest_neighbour", "joint_compatibility", "sequential_compatibility",
              "known_or_nearest", "known_or_joint", "appearance"}});
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
    v.value(
        "forget_after", forget_after,
        {"1",
         "Any landmark that is not seen in so many updates in a row is removed, a confirmed one "
         "too; 0: never. For odometry from tracked points, whose identities never come back.",
         0});
    v.value("extent_gap", extent_gap,
            {"m",
             "A line is another wall if, along it, it begins farther than this from all that was "
             "seen of the landmark.",
             0});
    v.value("merge_every", merge_every,
            {"1", "Lines of the map that agree are made one after every so many updates; 0: never.",
             0});
    v.value("merge_probability", merge_probability,
            {"1",
             "Two lines agree if the squared Mahalanobis distance between them is below this "
             "chi-square probability.",
             1e-6, 1});
    v.value("appearance_distance", appearance_distance,
            {"1",
             "Largest distance of two descriptors of one landmark: share of the bits, or of the "
             "length of a SIFT descriptor (appearance).",
             1e-6, 1});
    v.value("appearance_ratio", appearance_ratio,
            {"1", "Best descriptor distance over second best, at most (appearance).", 1e-6, 1});
  }
};

}  // namespace libslam
