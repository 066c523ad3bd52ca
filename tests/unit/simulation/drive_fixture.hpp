#pragma once
// Small scenarios and whole drives for tests of the simulation.

#include <cstdint>
#include <vector>

#include <mrpt/obs/CObservationBearingRange.h>

#include <libslam/pipeline/simulation.hpp>

namespace libslam::testing {

/// A random world, an ackermann vehicle, the range-bearing sensor, noise in motion and sensor.
inline Scenario small_scenario() {
  Scenario s;
  s.world.landmarks = 60;
  s.world.size_x = s.world.size_y = 80.0;
  s.motion.model = "ackermann";
  s.motion.ackermann_form = "seed";
  s.motion.wheelbase = 4.0;
  s.motion.noise = {};
  s.motion.noise.along_per_sqrt_m = 0.0;
  s.motion.noise.across_per_sqrt_m = 0.0;
  s.motion.noise.turn_per_sqrt_m = 0.0;
  s.motion.noise.turn_per_sqrt_rad = 0.0;
  s.motion.noise.along_per_sqrt_s = 0.02;
  s.motion.noise.steering_per_sqrt_s = 0.005;
  s.drive.max_duration_s = 20.0;
  return s;
}

inline Scenario differential_scenario() {
  Scenario s = small_scenario();
  s.motion.model = "differential";
  s.motion.track_width = 0.5;
  s.motion.noise.steering_per_sqrt_s = 0.0;
  s.motion.noise.turn_per_sqrt_s = 0.01;
  s.drive.speed = 1.0;
  return s;
}

inline std::vector<SimulatedStep> drive(const Scenario& scenario, std::uint64_t seed) {
  const auto simulator = make_simulator(scenario, seed);
  std::vector<SimulatedStep> steps;
  while (auto step = simulator->next()) steps.push_back(std::move(*step));
  return steps;
}

template <class Observation>
std::shared_ptr<const Observation> observation_of(const SimulatedStep& step) {
  return step.step.frame ? step.step.frame->getObservationByClass<Observation>() : nullptr;
}

/// Range and bearing of a landmark from the true pose (sensor at the origin of the robot).
inline Eigen::Vector2d true_sighting(const Eigen::Vector3d& T_world_robot,
                                     const Eigen::Vector2d& p_world) {
  const Eigen::Vector2d d = p_world - T_world_robot.head<2>();
  return {d.norm(), wrap_angle(std::atan2(d.y(), d.x()) - T_world_robot.z())};
}

}  // namespace libslam::testing
