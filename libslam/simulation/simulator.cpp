#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <mrpt/obs/CSensoryFrame.h>

#include <libslam/simulation/random_stream.hpp>
#include <libslam/simulation/simulator.hpp>

namespace libslam {

namespace {

/// 2026-01-01 00:00 UTC: any fixed time serves, and tools print this one as a date.
constexpr double kEpoch = 1767225600.0;
constexpr double kTicksPerSecond = 1e7;  // of MRPT's clock
// A way-point that is missed for this long cannot be reached: the vehicle circles around it.
constexpr double kPatience = 10.0, kLeastPatience_s = 60.0;

mrpt::system::TTimeStamp stamp_at(double elapsed) {
  using Duration = mrpt::Clock::duration;
  return mrpt::Clock::fromDouble(kEpoch) + Duration(std::llround(elapsed * kTicksPerSecond));
}

}  // namespace

Simulator::Simulator(const Scenario& scenario, World world, SimulatedVehicle vehicle,
                     std::uint64_t seed)
    : scenario_(scenario),
      world_(std::move(world)),
      vehicle_(std::move(vehicle)),
      calibration_(true_calibration(scenario)),
      driver_(scenario.drive, scenario.motion, world_.way_points),
      odometry_(scenario, vehicle_),
      faults_(scenario.faults, seed),
      sensors_(make_sensors(scenario, seed)),
      landmark_motion_(scenario.faults.moving_landmarks, world_.landmarks, seed),
      motion_random_(RandomStream(seed, RandomPurpose::kMotion)()),
      ticks_per_observation_(
          std::llround(scenario.drive.observation_period_s / scenario.drive.control_period_s)),
      time_limit_(kLeastPatience_s + kPatience *
                                         driver_.length_from(world_.T_world_start.head<2>()) /
                                         scenario.drive.speed),
      step_time_(mrpt::Clock::toDouble(stamp_at(0.0))),
      last_step_time_(step_time_),
      T_world_robot_(world_.T_world_start) {
  scene_.walls = RayCaster(world_.walls, {});
  for (const TrueLandmark& landmark : world_.landmarks) scene_.ids.push_back(landmark.id);
}

bool Simulator::finished() const {
  const double limit = scenario_.drive.max_duration_s;
  if (limit > 0.0 && elapsed() + 0.5 * scenario_.drive.control_period_s > limit) return true;
  if (elapsed() > time_limit_)
    throw std::runtime_error("way-point " +
                             std::to_string(driver_.reached() % world_.way_points.size() + 1) +
                             " is out of reach: the vehicle cannot turn sharply enough");
  return false;
}

void Simulator::move() {
  ++tick_;
  const double time = mrpt::Clock::toDouble(stamp_at(elapsed()));
  const double dt = time - step_time_;
  step_time_ = time;
  const Eigen::Vector2d command = driver_.command(T_world_robot_, scenario_.drive.control_period_s);
  const MotionAction action = odometry_.add(command, time, dt);
  const Eigen::Vector3d moved = vehicle_.actual->sample(T_world_robot_, {}, action, motion_random_);
  T_world_robot_ = faults_.disturb(T_world_robot_, moved, tick_, elapsed(), dt);
}

mrpt::obs::CSensoryFrame::Ptr Simulator::observe() {
  scene_.T_world_robot = T_world_robot_;
  scene_.elapsed = elapsed();
  scene_.observation = static_cast<std::uint64_t>(tick_ / ticks_per_observation_);
  scene_.stamp = stamp_at(elapsed());
  landmark_motion_.place(elapsed(), scene_.p_world);
  auto frame = mrpt::obs::CSensoryFrame::Create();
  for (const auto& sensor : sensors_) frame->insert(sensor->observe(scene_));
  return frame;
}

SimulatedStep Simulator::finish_step(LogStep step) {
  step.index = index_++;
  step.time = step_time_;
  if (step.action) step.dt = step_time_ - last_step_time_;
  step.has_motion_covariance = step.action && odometry_.has_covariance();
  last_step_time_ = step_time_;
  return {std::move(step), T_world_robot_};
}

std::optional<SimulatedStep> Simulator::next() {
  LogStep step;
  if (index_ == 0) {
    step.frame = observe();
    return finish_step(std::move(step));
  }
  const bool merged = scenario_.log.flavour == "merged_pairs";
  do {
    if (driver_.arrive(T_world_robot_) || finished()) return std::nullopt;
    move();
  } while (merged && !observation_due());
  step.action = odometry_.take(stamp_at(elapsed()));
  if (observation_due()) step.frame = observe();
  return finish_step(std::move(step));
}

}  // namespace libslam
