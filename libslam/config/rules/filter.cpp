#include <string>

#include <libslam/config/rules/rules.hpp>

namespace libslam {

void check_filter(const Parameters& p, TruthAccess truth, Conflicts& conflicts) {
  const FilterParameters& f = p.filter;
  if (f.update_linearizations > 1 && f.linearization != "estimate") {
    conflicts.push_back({{"filter.update_linearizations", "filter.linearization"},
                         "iterations look for the best point to linearize at, the other key says "
                         "where it is"});
  }
  if (f.update_linearizations > 1 && p.measurement.model == "sensor_displacement") {
    conflicts.push_back({{"filter.update_linearizations", "measurement.model"},
                         "only sightings of landmarks are iterated"});
  }
  if (f.loop_closure.enabled && !(f.delayed_pose_distance > 0.0)) {
    conflicts.push_back({{"filter.loop_closure.enabled", "filter.delayed_pose_distance"},
                         "a closed loop is a measurement between poses of the past"});
  }
  if (f.loop_closure.enabled && p.frontend.source != "scan_lines") {
    conflicts.push_back({{"filter.loop_closure.enabled", "frontend.source"},
                         "old places are found again by laser scans"});
  }
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

namespace {

void check_noise_adaptation(const Parameters& p, Conflicts& conflicts) {
  const NoiseAdaptationParameters& n = p.policies.noise_adaptation;
  const std::string section = "policies.noise_adaptation.";
  if (n.bias && n.method == "off") {
    conflicts.push_back({{section + "bias", section + "method"},
                         "the offset is learned together with R, and R is not adapted"});
  }
  if (n.method == "off") {
    return;
  }
  if (p.measurement.model == "sensor_displacement") {
    conflicts.push_back({{section + "method", "measurement.model"},
                         "only the noise of landmark sightings is adapted"});
  }
  if (p.measurement.model == "stereo_point" && p.measurement.stereo.landmark_dimension == 2) {
    conflicts.push_back({{section + "method", "measurement.stereo.landmark_dimension"},
                         "a planar landmark leaves the rows of the images out, and with them a "
                         "part of R that nothing would teach"});
  }
  if (n.bias && (p.map.file.empty() || p.map.mode != "localize")) {
    conflicts.push_back({{section + "bias", "map.mode"},
                         "a map that is being made takes up a constant offset of its "
                         "measurements; only a known map tells the two apart"});
  }
  if (n.min_sigma_pixel >= n.max_sigma_pixel) {
    conflicts.push_back({{section + "min_sigma_pixel", section + "max_sigma_pixel"},
                         "no sigma lies between a floor and a ceiling in this order"});
  }
  if (n.min_sigma_range >= n.max_sigma_range) {
    conflicts.push_back({{section + "min_sigma_range", section + "max_sigma_range"},
                         "no sigma lies between a floor and a ceiling in this order"});
  }
  if (n.min_sigma_bearing_deg >= n.max_sigma_bearing_deg) {
    conflicts.push_back({{section + "min_sigma_bearing_deg", section + "max_sigma_bearing_deg"},
                         "no sigma lies between a floor and a ceiling in this order"});
  }
}

void check_process_adaptation(const Parameters& p, Conflicts& conflicts) {
  const ProcessAdaptationParameters& q = p.policies.process_adaptation;
  const std::string section = "policies.process_adaptation.";
  if (q.method == "off") {
    return;
  }
  if (p.policies.noise_adaptation.method != "off") {
    conflicts.push_back({{section + "method", "policies.noise_adaptation.method"},
                         "an innovation that is too large can be explained by Q or by R; learning "
                         "both from it lets either run away"});
  }
  if (p.measurement.model == "sensor_displacement") {
    conflicts.push_back({{section + "method", "measurement.model"},
                         "only sightings of landmarks teach the noise of the odometry"});
  }
  if (q.min_factor >= q.max_factor) {
    conflicts.push_back({{section + "min_factor", section + "max_factor"},
                         "no factor lies between a floor and a ceiling in this order"});
  }
}

void check_disturbance(const Parameters& p, Conflicts& conflicts) {
  const DisturbanceParameters& d = p.policies.disturbance;
  if (d.response == "none") {
    return;
  }
  if (p.measurement.model == "sensor_displacement") {
    conflicts.push_back({{"policies.disturbance.response", "measurement.model"},
                         "a disturbance is noticed by landmarks; without a map nothing tells it "
                         "from a wrong displacement"});
  }
  if (d.relocalize && p.filter.linearization != "estimate") {
    conflicts.push_back({{"policies.disturbance.relocalize", "filter.linearization"},
                         "a pose that is found anew has no history of points to linearize at; "
                         "take the estimate, or false"});
  }
  if (p.association.forget_after > 0) {
    conflicts.push_back({{"policies.disturbance.response", "association.forget_after"},
                         "in doubt no landmark is added, and those that are forgotten meanwhile "
                         "leave nothing to find back with; policies.implied_input is the test for "
                         "tracked points"});
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

}  // namespace

void check_policies(const Parameters& p, Conflicts& conflicts) {
  const UpdateScheduleParameters& schedule = p.policies.update_schedule;
  if (schedule.per_feature > 0.0 && schedule.form == "relative" &&
      !(p.policies.update_period_s > 0.0)) {
    conflicts.push_back({{"policies.update_schedule.per_feature", "policies.update_period_s"},
                         "there is no period to stretch; give one, or take the absolute form"});
  }
  check_noise_adaptation(p, conflicts);
  check_process_adaptation(p, conflicts);
  check_disturbance(p, conflicts);
}

}  // namespace libslam
