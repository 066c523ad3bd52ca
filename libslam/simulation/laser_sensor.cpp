#include <algorithm>
#include <cmath>

#include <mrpt/obs/CObservation2DRangeScan.h>

#include <libslam/simulation/laser_sensor.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

using mrpt::obs::CObservation2DRangeScan;

LaserSensor::LaserSensor(const Scenario& scenario, std::uint64_t seed)
    : parameters_(scenario.laser),
      mount_(parameters_.pose, scenario.truth),
      noise_(scenario.faults, seed, RandomPurpose::kLaser, RandomPurpose::kLaserOutlier),
      trunk_radius_(scenario.world.trunk_radius),
      trunks_move_(scenario.faults.moving_landmarks.enabled) {
  const double aperture = to_radians(parameters_.aperture_deg);
  for (int i = 0; i < parameters_.beams; ++i) {
    const double angle = aperture * (static_cast<double>(i) / (parameters_.beams - 1) - 0.5);
    directions_.emplace_back(std::cos(angle), std::sin(angle));
  }
}

void LaserSensor::place_trunks(const SensorScene& scene) {
  if (trunks_placed_ && !trunks_move_) return;
  std::vector<Trunk> trunks;
  for (const Eigen::Vector3d& p : scene.p_world) trunks.push_back({p.head<2>(), trunk_radius_});
  trunks_ = RayCaster({}, trunks);
  trunks_placed_ = true;
}

double LaserSensor::distance_to_nearest(const SensorScene& scene,
                                        const Eigen::Vector3d& T_world_sensor,
                                        const Eigen::Vector2d& beam) const {
  const Eigen::Vector2d origin = T_world_sensor.head<2>();
  const Eigen::Vector2d direction = transform_point(T_world_sensor, beam) - origin;
  return trunks_.cast(origin, direction,
                      scene.walls.cast(origin, direction, parameters_.max_range));
}

mrpt::obs::CObservation::Ptr LaserSensor::observe(const SensorScene& scene) {
  place_trunks(scene);
  auto observation = CObservation2DRangeScan::Create();
  observation->timestamp = scene.stamp;
  observation->sensorLabel = "laser";
  observation->sensorPose = mount_.logged_pose();
  observation->aperture = static_cast<float>(to_radians(parameters_.aperture_deg));
  observation->rightToLeft = true;
  observation->maxRange = static_cast<float>(parameters_.max_range);
  observation->stdError = static_cast<float>(parameters_.sigma_range);
  observation->resizeScan(directions_.size());
  const Eigen::Vector3d T_world_sensor = compose_poses(scene.T_world_robot, mount_.actual);
  RandomStream random = noise_.stream(scene), outliers = noise_.outlier_stream(scene);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, parameters_.max_range);
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    double range = distance_to_nearest(scene, T_world_sensor, directions_[i]);
    const double draw = normal(random);  // every beam takes one, whatever it meets
    if (range < parameters_.max_range)
      range += noise_.factor(scene.elapsed, range) * parameters_.sigma_range * draw;
    if (noise_.draw_outlier(outliers)) range = uniform(outliers);
    const bool valid = range > 0.0 && range < parameters_.max_range;
    observation->setScanRange(i, static_cast<float>(valid ? range : parameters_.max_range));
    observation->setScanRangeValidity(i, valid);
  }
  return observation;
}

}  // namespace libslam
