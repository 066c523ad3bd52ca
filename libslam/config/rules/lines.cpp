#include <libslam/config/rules/rules.hpp>

namespace libslam {
namespace {

bool in_space(const Parameters& p) {
  return p.motion.model == "body_twist" || p.motion.model == "constant_twist";
}

void check_upkeep(const Parameters& p, bool lines, Conflicts& conflicts) {
  if (p.filter.building_prior.enabled && !lines) {
    conflicts.push_back({{"filter.building_prior.enabled", "measurement.model"},
                         "only lines have a direction that a building could explain"});
  }
  if (p.association.merge_every > 0 && !lines) {
    conflicts.push_back({{"association.merge_every", "measurement.model"},
                         "only lines are told by themselves whether two of them are one"});
  }
}

void check_line_policies(const Parameters& p, Conflicts& conflicts) {
  if (p.policies.noise_adaptation.method != "off") {
    conflicts.push_back({{"policies.noise_adaptation.method", "measurement.model"},
                         "every line brings the covariance of its own points; no two have one R "
                         "to learn"});
  }
  if (p.policies.disturbance.response != "none" && p.policies.disturbance.relocalize) {
    conflicts.push_back({{"policies.disturbance.relocalize", "measurement.model"},
                         "a lost pose is found again among points alone; set it to false"});
  }
}

}  // namespace

void check_lines(const Parameters& p, Conflicts& conflicts) {
  const bool lines = p.measurement.model == "line";
  if (lines != (p.frontend.source == "scan_lines")) {
    conflicts.push_back({{"measurement.model", "frontend.source"},
                         "line measures the lines of scan_lines, and nothing else does"});
  }
  check_upkeep(p, lines, conflicts);
  if (!lines) {
    return;
  }
  if (in_space(p)) {
    conflicts.push_back(
        {{"measurement.model", "motion.model"}, "lines are those of a plane; so is the robot"});
  }
  if (p.association.uses_identities()) {
    conflicts.push_back({{"association.method", "measurement.model"},
                         "walls do not say who they are; take sequential_compatibility"});
  }
  if (p.filter.linearization != "estimate") {
    conflicts.push_back({{"filter.linearization", "measurement.model"},
                         "another point than the estimate is derived for points alone"});
  }
  check_line_policies(p, conflicts);
}

}  // namespace libslam
