#pragma once
// Contract of simulated sensors.
//
// Given   the true state of the world at one time,
// Then    `observe` returns what MRPT would have recorded then: never null, without entries where
//         nothing is in view; noise depends on the seed, the sensor and the running number of the
//         observation alone.

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <mrpt/obs/CObservation.h>
#include <mrpt/system/datetime.h>

#include <libslam/simulation/ray_caster.hpp>
#include <libslam/simulation/scenario.hpp>

namespace libslam {

/// The world as it is at the time of an observation.
struct SensorScene {
  Eigen::Vector3d T_world_robot = Eigen::Vector3d::Zero();  ///< true pose
  double elapsed = 0.0;                                     ///< since the start [s]
  std::uint64_t observation = 0;                            ///< running number
  mrpt::system::TTimeStamp stamp{};
  std::vector<std::int64_t> ids;         ///< of the landmarks
  std::vector<Eigen::Vector3d> p_world;  ///< where they stand now [m]
  RayCaster walls;                       ///< hide what is behind them
};

class SimulatedSensor {
 public:
  virtual ~SimulatedSensor() = default;
  virtual mrpt::obs::CObservation::Ptr observe(const SensorScene& scene) = 0;
};

/// Every sensor that is enabled, in a fixed order.
std::vector<std::unique_ptr<SimulatedSensor>> make_sensors(const Scenario& scenario,
                                                           std::uint64_t seed);

}  // namespace libslam
