#pragma once
// Drives a vehicle through a world and writes down what its sensors would have said.
//
//   command (v, omega) -> what the nominal vehicle logs -> actual->sample(true pose, logged action)
//
// The truth is drawn from the motion model itself, given the action of the log and the true
// calibration: exactly what a filter with the same model assumes, whatever the model. Slips and
// kidnaps act on the truth alone. Every purpose has its own random numbers (random_stream.hpp), so
// that switching a sensor or a fault on changes nothing else.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/ground_truth.hpp>
#include <libslam/data/log_step.hpp>
#include <libslam/motion/motion_model.hpp>
#include <libslam/simulation/landmark_motion.hpp>
#include <libslam/simulation/odometry_log.hpp>
#include <libslam/simulation/scenario.hpp>
#include <libslam/simulation/sensor.hpp>
#include <libslam/simulation/vehicle_faults.hpp>
#include <libslam/simulation/way_point_driver.hpp>
#include <libslam/simulation/world.hpp>

namespace libslam {

/// One step of the log and the truth at its end.
struct SimulatedStep {
  LogStep step;  ///< frame null where no observation was due
  Eigen::Vector3d T_world_robot = Eigen::Vector3d::Zero();  ///< true pose x [m], y [m], phi [rad]
};

class Simulator {
 public:
  /// `scenario` must be valid (pipeline/simulation.hpp). Throws std::invalid_argument where the
  /// world has no way-points.
  Simulator(const Scenario& scenario, World world, SimulatedVehicle vehicle, std::uint64_t seed);

  /// The next step, nothing at the end of the last lap. The first one has no action and the first
  /// observation. Times and intervals are those that RawlogPlayer reads back from a log of the
  /// same flavour; `observations` gives the steps of `pairs`. Throws std::runtime_error where a
  /// way-point cannot be reached.
  std::optional<SimulatedStep> next();

  /// Part of the way-points reached, in [0, 1].
  double progress() const { return driver_.progress(); }

  /// Where landmarks stood at the start, world frame.
  const std::vector<TrueLandmark>& landmarks() const { return world_.landmarks; }
  const World& world() const { return world_; }
  /// What a perfect filter would find, by CalibrationValue::name, each parameter with the others at
  /// their nominal values: the wheel factors include the speed factor and the other way round.
  const std::map<std::string, double>& calibration() const { return calibration_; }
  Eigen::Vector3d start() const { return world_.T_world_start; }

 private:
  double elapsed() const { return static_cast<double>(tick_) * scenario_.drive.control_period_s; }
  bool observation_due() const { return tick_ % ticks_per_observation_ == 0; }
  bool finished() const;
  void move();
  mrpt::obs::CSensoryFrame::Ptr observe();
  SimulatedStep finish_step(LogStep step);

  Scenario scenario_;
  World world_;
  SimulatedVehicle vehicle_;
  std::map<std::string, double> calibration_;
  WayPointDriver driver_;
  OdometryLog odometry_;
  VehicleFaults faults_;
  std::vector<std::unique_ptr<SimulatedSensor>> sensors_;
  LandmarkMotion landmark_motion_;
  SensorScene scene_;
  std::mt19937_64 motion_random_;
  std::int64_t ticks_per_observation_;
  double time_limit_;
  std::int64_t tick_ = 0;  ///< commands so far
  std::int64_t index_ = 0;
  double step_time_ = 0.0;  ///< of the last command [s since 1970]
  double last_step_time_ = 0.0;
  Eigen::Vector3d T_world_robot_;
};

}  // namespace libslam
