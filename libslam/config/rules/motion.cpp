#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <libslam/config/rules/rules.hpp>

namespace libslam {
namespace {

struct CalibrationEntry {
  const char* name;
  const CalibrationParameter& parameter;
  bool is_scale;
  bool of_increment, of_differential, of_ackermann, of_twist;  ///< the motion model has it
};

std::array<CalibrationEntry, 11> list_calibration(const CalibrationParameters& c) {
  return {{{"scale_left", c.scale_left, true, false, true, true, false},
           {"scale_right", c.scale_right, true, false, true, true, false},
           {"track_width", c.track_width, true, false, true, false, false},
           {"scale_speed", c.scale_speed, true, true, false, true, true},
           {"scale_steering", c.scale_steering, true, false, false, true, false},
           {"bias_steering", c.bias_steering, false, false, false, true, false},
           {"scale_turn", c.scale_turn, true, true, false, false, false},
           {"bias_turn", c.bias_turn, false, true, false, false, false},
           {"bias_gyro_x", c.bias_gyro_x, false, false, false, false, true},
           {"bias_gyro_y", c.bias_gyro_y, false, false, false, false, true},
           {"bias_gyro_z", c.bias_gyro_z, false, false, false, false, true}}};
}

void check_no_odometry(const Parameters& p, Conflicts& conflicts) {
  // The velocity of constant_twist is a state, which takes the robot on.
  const bool keeps_velocity = p.motion.model == "constant_twist";
  const bool diffuses =
      p.motion.no_odometry_sigma_xy > 0.0 && p.motion.no_odometry_sigma_heading_deg > 0.0;
  if (!diffuses && !keeps_velocity) {
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

/// Scans are matched against pose increments of a robot in the plane, and give such increments.
void check_scan_matching(const Parameters& p, Conflicts& conflicts) {
  if (!p.input.scan_matching.enabled) return;
  if (p.input.odometry != "auto" && p.input.odometry != "increments")
    conflicts.push_back({{"input.scan_matching.enabled", "input.odometry"},
                         "matched increments take the place of pose increments; input.odometry " +
                             p.input.odometry + " reads other fields of the log"});
  if (p.motion.model != "odometry_increment" || p.motion.increment_form != "composition")
    conflicts.push_back({{"input.scan_matching.enabled", "motion.model", "motion.increment_form"},
                         "matched increments go sideways, too: only odometry_increment in the form "
                         "composition takes them as they are"});
}

}  // namespace

void check_input(const Parameters& p, Conflicts& conflicts) {
  check_scan_matching(p, conflicts);
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
    const bool is_observable = (model == "odometry_increment" && entry.of_increment) ||
                               (model == "differential" && entry.of_differential) ||
                               (model == "ackermann" && entry.of_ackermann) ||
                               (model == "body_twist" && entry.of_twist);
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

}  // namespace libslam
