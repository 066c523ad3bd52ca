#pragma once
// A 2-D laser among walls and round trunks -> CObservation2DRangeScan.

#include <vector>

#include <libslam/simulation/sensor_noise.hpp>

namespace libslam {

/// Beams run counter-clockwise over the aperture, both ends included. A beam that meets nothing
/// within range is invalid and reads max_range. Landmarks are trunks where `world.trunk_radius` is
/// positive. All beams of a scan are taken at once.
class LaserSensor final : public SimulatedSensor {
 public:
  LaserSensor(const Scenario& scenario, std::uint64_t seed);
  mrpt::obs::CObservation::Ptr observe(const SensorScene& scene) override;

 private:
  void place_trunks(const SensorScene& scene);
  /// Along a beam, a unit vector of the sensor frame; max_range where nothing is nearer.
  double distance_to_nearest(const SensorScene& scene, const Eigen::Vector3d& T_world_sensor,
                             const Eigen::Vector2d& beam) const;

  LaserSensorParameters parameters_;
  SensorMount mount_;
  SensorNoise noise_;
  double trunk_radius_;
  bool trunks_move_;
  RayCaster trunks_;
  bool trunks_placed_ = false;
  std::vector<Eigen::Vector2d> directions_;  ///< unit vectors of the beams, sensor frame
};

}  // namespace libslam
