#include <algorithm>
#include <array>
#include <cmath>

#include <libslam/config/parameter_table.hpp>
#include <libslam/config/validation.hpp>

namespace libslam {
namespace {

using Conflicts = std::vector<Conflict>;

struct CalibrationEntry {
  const char* name;
  const CalibrationParameter& parameter;
  bool is_scale;
  bool of_differential, of_ackermann;  ///< the motion model has this parameter
};

std::array<CalibrationEntry, 6> list_calibration(const CalibrationParameters& c) {
  return {{{"scale_left", c.scale_left, true, true, true},
           {"scale_right", c.scale_right, true, true, true},
           {"track_width", c.track_width, true, true, false},
           {"scale_speed", c.scale_speed, true, false, true},
           {"scale_steering", c.scale_steering, true, false, true},
           {"bias_steering", c.bias_steering, false, false, true}}};
}

void check_no_odometry(const Parameters& p, Conflicts& conflicts) {
  if (!(p.motion.no_odometry_sigma_xy > 0.0) || !(p.motion.no_odometry_sigma_heading_deg > 0.0)) {
    conflicts.push_back(
        {{"input.odometry", "motion.no_odometry_sigma_xy", "motion.no_odometry_sigma_heading_deg"},
         "without odometry and without noise in its place the robot could never "
         "move"});
  }
  for (const CalibrationEntry& entry : list_calibration(p.calibration)) {
    if (entry.parameter.enabled) {
      conflicts.push_back(
          {{std::string("calibration.") + entry.name + ".enabled", "input.odometry"},
           "without odometry there is nothing to calibrate"});
    }
  }
}

void check_input(const Parameters& p, Conflicts& conflicts) {
  if (p.input.odometry == "none") {
    check_no_odometry(p, conflicts);
  }
  if (p.input.odometry != "ticks") {
    return;
  }
  const bool both_rear_wheels = p.motion.model == "ackermann" && p.motion.encoder_offset == 0.0;
  if (p.motion.model != "differential" && !both_rear_wheels) {
    conflicts.push_back(
        {{"input.odometry", "motion.model"},
         "encoder ticks of a left and a right wheel drive the differential model, or "
         "ackermann with encoder_offset 0; " +
             p.motion.model + " needs increments or velocities"});
    return;
  }
  for (const auto& [key, value] :
       {std::pair("motion.metres_per_tick_left", p.motion.metres_per_tick_left),
        std::pair("motion.metres_per_tick_right", p.motion.metres_per_tick_right)}) {
    if (!(value > 0.0)) {
      conflicts.push_back({{key, "input.odometry"}, "ticks need a positive travel per tick"});
    }
  }
}

void check_calibration(const Parameters& p, Conflicts& conflicts) {
  const std::string& model = p.motion.model;
  for (const CalibrationEntry& entry : list_calibration(p.calibration)) {
    const std::string section = std::string("calibration.") + entry.name;
    const CalibrationParameter& c = entry.parameter;
    const bool is_observable = (model == "differential" && entry.of_differential) ||
                               (model == "ackermann" && entry.of_ackermann);
    if (c.enabled && !is_observable) {
      conflicts.push_back({{section + ".enabled", "motion.model"},
                           "motion model " + model +
                               " does not depend on this parameter, so nothing could estimate it"});
    }
    if (c.enabled && !(c.prior_sigma > 0.0)) {
      conflicts.push_back({{section + ".prior_sigma"},
                           "a prior without uncertainty makes the parameter inert: it would never "
                           "be updated"});
    }
    if (entry.is_scale && !(c.prior_mean > 0.0)) {
      conflicts.push_back({{section + ".prior_mean"},
                           "a factor must be positive, otherwise the robot stands or runs "
                           "backwards"});
    }
  }
  if (!(std::abs(p.calibration.bias_steering.prior_mean) < kPi / 2)) {
    conflicts.push_back({{"calibration.bias_steering.prior_mean"},
                         "a steering angle must stay within a quarter turn (pi/2 rad)"});
  }
  const bool has_wheel_scale =
      p.calibration.scale_left.enabled || p.calibration.scale_right.enabled;
  if (p.calibration.scale_speed.enabled && has_wheel_scale) {
    conflicts.push_back({{"calibration.scale_speed.enabled",
                          p.calibration.scale_left.enabled ? "calibration.scale_left.enabled"
                                                           : "calibration.scale_right.enabled"},
                         "the common speed factor and the factor of a wheel act on the same motion "
                         "and cannot be told apart; enable one of them"});
  }
}

void check_frontend(const Parameters& p, Conflicts& conflicts) {
  if (p.frontend.min_range >= p.frontend.max_range) {
    conflicts.push_back({{"frontend.min_range", "frontend.max_range"},
                         "no observation lies between a nearest and a farthest range in this "
                         "order"});
  }
}

/// Displacements of a sensor take the place of landmarks; the two do not mix.
void check_displacement(const Parameters& p, Conflicts& conflicts) {
  const bool measures = p.measurement.model == "sensor_displacement";
  if (measures != (p.frontend.source == "sensor_path")) {
    conflicts.push_back(
        {{"measurement.model", "frontend.source"},
         "sensor_displacement measures along a sensor_path, and nothing else does"});
  }
  for (const auto& [name, parameter] :
       {std::pair("calibration.sensor_x.enabled", &p.calibration.sensor_x),
        std::pair("calibration.sensor_y.enabled", &p.calibration.sensor_y),
        std::pair("calibration.sensor_phi.enabled", &p.calibration.sensor_phi)}) {
    if (parameter->enabled && !measures) {
      conflicts.push_back({{name, "measurement.model"},
                           "landmark models take the pose of the sensor from the log; only "
                           "sensor_displacement estimates it"});
    }
  }
  if (!measures) {
    return;
  }
  if (p.input.sensor_label.empty()) {
    conflicts.push_back({{"input.sensor_label", "measurement.model"},
                         "the label tells the path of the sensor from the odometry of the robot"});
  }
  if (p.input.sensor_label == p.input.odometry_label && !p.input.sensor_label.empty()) {
    conflicts.push_back({{"input.sensor_label", "input.odometry_label"},
                         "the odometry of the robot cannot be its own measurement"});
  }
  if (p.input.odometry == "none") {
    conflicts.push_back({{"measurement.model", "input.odometry"},
                         "without odometry there is nothing to compare a displacement with"});
  }
  if (p.filter.linearization != "estimate") {
    conflicts.push_back({{"filter.linearization", "measurement.model"},
                         "displacements are linearized at the estimate"});
  }
}

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
}

}  // namespace

std::vector<Conflict> find_range_conflicts(const ParameterTable& table) {
  Conflicts conflicts;
  for (const ParameterEntry& entry : list_parameters(table)) {
    try {
      assign_parameter(table, entry.name, entry.value);
    } catch (const ConfigError& error) {
      const std::string message = error.what();
      conflicts.push_back({{entry.name}, message.substr(entry.name.size() + 2)});
    }
  }
  return conflicts;
}

std::vector<Conflict> find_conflicts(const Parameters& parameters, TruthAccess truth) {
  Parameters copy = parameters;
  Conflicts conflicts = find_range_conflicts(ParameterTable(copy));
  check_input(parameters, conflicts);
  check_calibration(parameters, conflicts);
  check_frontend(parameters, conflicts);
  check_displacement(parameters, conflicts);
  check_association(parameters, conflicts);
  check_filter(parameters, truth, conflicts);
  check_policies(parameters, conflicts);
  return conflicts;
}

void throw_first(const std::vector<Conflict>& conflicts, const ParameterTable& table,
                 const ParameterPlaces& places) {
  if (conflicts.empty()) {
    return;
  }
  const Conflict& first = conflicts.front();
  const auto entries = list_parameters(table);
  std::string place, names;
  for (const std::string& key : first.keys) {
    const auto known = places.find(key);
    if (place.empty() && known != places.end()) {
      place = known->second + ": ";
    }
    const auto entry = std::ranges::find(entries, key, &ParameterEntry::name);
    names += (names.empty() ? "" : " with ") + key + " = " + entry->value;
  }
  throw ConfigError(place + names + ": " + first.reason);
}

void validate(const Parameters& parameters, const ParameterPlaces& places, TruthAccess truth) {
  Parameters copy = parameters;
  throw_first(find_conflicts(parameters, truth), ParameterTable(copy), places);
}

}  // namespace libslam
