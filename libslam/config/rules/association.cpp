#include <libslam/config/rules/rules.hpp>

namespace libslam {

void check_association(const Parameters& p, Conflicts& conflicts) {
  const AssociationParameters& a = p.association;
  if (!(a.gate_probability > 0.0)) {
    conflicts.push_back({{"association.gate_probability"}, "a gate of 0 rejects every sighting"});
  }
  if (a.method != "known") {
    if (a.gate_probability >= 1.0) {
      conflicts.push_back({{"association.gate_probability", "association.method"},
                           "without a gate every observation fits some landmark and none is ever "
                           "new"});
    }
    if (a.gate_probability > a.new_landmark_probability) {
      conflicts.push_back({{"association.gate_probability", "association.new_landmark_probability"},
                           "an observation between the two would be a sighting and a new landmark "
                           "at once"});
    }
    if (a.new_landmark_probability >= 1.0) {
      conflicts.push_back({{"association.new_landmark_probability"},
                           "at probability 1 no observation ever starts a landmark"});
    }
  }
  if (a.prune_after > 0 && a.prune_after + 1 < a.confirm_after) {
    conflicts.push_back({{"association.prune_after", "association.confirm_after"},
                         "every landmark is removed before it can have been seen often enough"});
  }
}

}  // namespace libslam
