#include <cmath>

#include <libslam/config/parameter_table.hpp>
#include <libslam/pipeline/simulation.hpp>

namespace libslam {

namespace {

using Conflicts = std::vector<Conflict>;

void check_world(const Scenario& s, Conflicts& conflicts) {
  if (s.world.generator == "file") {
    if (s.world.landmarks_file.empty())
      conflicts.push_back({{"world.landmarks_file", "world.generator"}, "the file is missing"});
    if (s.world.way_points_file.empty())
      conflicts.push_back({{"world.way_points_file", "world.generator"}, "the file is missing"});
  }
  if (s.world.generator == "rooms" &&
      s.world.door_width >= std::min(s.world.room_size_x, s.world.room_size_y))
    conflicts.push_back({{"world.door_width", "world.room_size_x", "world.room_size_y"},
                         "a door must be narrower than its wall"});
}

void check_drive(const Scenario& s, Conflicts& conflicts) {
  const double ratio = s.drive.observation_period_s / s.drive.control_period_s;
  if (ratio < 0.5 || std::abs(ratio - std::round(ratio)) > 1e-6 * ratio)
    conflicts.push_back({{"drive.observation_period_s", "drive.control_period_s"},
                         "observations fall between commands; take a whole multiple"});
}

/// A true value that the motion model does not depend on would be silently without effect.
void check_truth(const Scenario& s, Conflicts& conflicts) {
  const bool differential = s.motion.model == "differential";
  const bool ackermann = s.motion.model == "ackermann";
  const TruthParameters &t = s.truth, nominal;
  const auto check = [&](const char* key, double value, double unchanged, bool has) {
    if (!has && value != unchanged)
      conflicts.push_back({{std::string("truth.") + key, "motion.model"},
                           "this vehicle does not have the parameter"});
  };
  check("scale_left", t.scale_left, nominal.scale_left, differential || ackermann);
  check("scale_right", t.scale_right, nominal.scale_right, differential || ackermann);
  check("track_width", t.track_width, nominal.track_width, differential);
  check("scale_speed", t.scale_speed, nominal.scale_speed, ackermann);
  check("scale_steering", t.scale_steering, nominal.scale_steering, ackermann);
  check("bias_steering_deg", t.bias_steering_deg, nominal.bias_steering_deg, ackermann);
}

void check_log(const Scenario& s, Conflicts& conflicts) {
  if (s.log.odometry == "ticks") {
    const bool two_encoders = s.motion.model == "differential" ||
                              (s.motion.model == "ackermann" && s.motion.encoder_offset == 0.0);
    if (!two_encoders)
      conflicts.push_back({{"log.odometry", "motion.model", "motion.encoder_offset"},
                           "ticks need a left and a right wheel: differential, or ackermann "
                           "without encoder offset"});
    for (const auto& [key, value] :
         {std::pair("motion.metres_per_tick_left", s.motion.metres_per_tick_left),
          std::pair("motion.metres_per_tick_right", s.motion.metres_per_tick_right)})
      if (!(value > 0.0))
        conflicts.push_back({{key, "log.odometry"}, "ticks need a positive travel per tick"});
  }
}

void check_sensors(const Scenario& s, Conflicts& conflicts) {
  if (s.range_bearing.enabled &&
      (!(s.range_bearing.sigma_range > 0.0) || !(s.range_bearing.sigma_bearing_deg > 0.0)))
    conflicts.push_back({{"range_bearing.sigma_range", "range_bearing.sigma_bearing_deg"},
                         "a log without sensor noise is one that states none; take a small one"});
  if (s.stereo_images.enabled && s.stereo_images.camera_height >= s.stereo_images.wall_height)
    conflicts.push_back({{"stereo_images.camera_height", "stereo_images.wall_height"},
                         "the cameras must be below the ceiling"});
  if (s.faults.noise_step.enabled && s.faults.noise_step.end_s <= s.faults.noise_step.begin_s)
    conflicts.push_back({{"faults.noise_step.end_s", "faults.noise_step.begin_s"},
                         "the step ends before it begins"});
}

}  // namespace

std::vector<Conflict> find_conflicts(const Scenario& scenario) {
  Scenario copy = scenario;
  Conflicts conflicts = find_range_conflicts(ParameterTable(copy));
  check_world(scenario, conflicts);
  check_drive(scenario, conflicts);
  check_truth(scenario, conflicts);
  check_log(scenario, conflicts);
  check_sensors(scenario, conflicts);
  return conflicts;
}

void validate(const Scenario& scenario, const ParameterPlaces& places) {
  Scenario copy = scenario;
  throw_first(find_conflicts(scenario), ParameterTable(copy), places);
}

}  // namespace libslam
