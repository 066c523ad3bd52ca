#include <libslam/config/rules/rules.hpp>

namespace libslam {

void check_filter(const Parameters& p, TruthAccess truth, Conflicts& conflicts) {
  const FilterParameters& f = p.filter;
  if (f.linearization == "estimate") {
    return;
  }
  if (f.error_frame != "standard") {
    conflicts.push_back({{"filter.linearization", "filter.error_frame"},
                         "each of the two alone keeps the unobservable directions free of "
                         "information; the invariant error is derived at the estimate, take the "
                         "standard frame for another point"});
  }
  if (f.linearization != "at_truth") {
    return;
  }
  if (truth == TruthAccess::kNone) {
    conflicts.push_back({{"filter.linearization"},
                         "only the simulated runs of a campaign know the truth; a log does not"});
  }
  if (p.association.method != "known") {
    conflicts.push_back({{"filter.linearization", "association.method"},
                         "the true place of a landmark is known by its identity"});
  }
}

void check_policies(const Parameters& p, Conflicts& conflicts) {
  if (p.policies.update_period_s > 0.0 && p.policies.update_every_n > 1) {
    conflicts.push_back({{"policies.update_every_n", "policies.update_period_s"},
                         "two schedules for the same updates; keep the period or the count"});
  }
  const DisturbanceParameters& d = p.policies.disturbance;
  if (d.response == "none") {
    return;
  }
  if (p.measurement.model == "sensor_displacement") {
    conflicts.push_back({{"policies.disturbance.response", "measurement.model"},
                         "a disturbance is noticed by landmarks; without a map nothing tells it "
                         "from a wrong displacement"});
  }
  if (d.trigger_probability >= 1.0 || d.release_probability >= 1.0) {
    conflicts.push_back(
        {{"policies.disturbance.trigger_probability", "policies.disturbance.release_probability"},
         "at probability 1 no observation is ever beyond the level"});
  }
  if (d.release_probability > d.trigger_probability) {
    conflicts.push_back(
        {{"policies.disturbance.release_probability", "policies.disturbance.trigger_probability"},
         "a disturbance would end where it begins; release it at a lower level"});
  }
}

}  // namespace libslam
