#include <cmath>

#include <mrpt/obs/CObservationBearingRange.h>

#include <libslam/data/feature.hpp>
#include <libslam/simulation/range_bearing_sensor.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

using mrpt::obs::CObservationBearingRange;

RangeBearingSensor::RangeBearingSensor(const Scenario& scenario, std::uint64_t seed)
    : parameters_(scenario.range_bearing),
      mount_(parameters_.pose, scenario.truth),
      noise_(scenario.faults, seed, RandomPurpose::kRangeBearing,
             RandomPurpose::kRangeBearingOutlier),
      identities_(scenario.log.identities),
      sigma_bearing_(to_radians(parameters_.sigma_bearing_deg)),
      half_view_(to_radians(parameters_.field_of_view_deg) / 2) {}

Eigen::Vector2d RangeBearingSensor::disturb(const Eigen::Vector2d& truth, const SensorScene& scene,
                                            std::size_t landmark) const {
  RandomStream random = noise_.stream(scene, landmark),
               outlier = noise_.outlier_stream(scene, landmark);
  if (noise_.draw_outlier(outlier)) {
    std::uniform_real_distribution<double> uniform;
    const double range = parameters_.max_range * uniform(outlier);
    return {range, half_view_ * (2.0 * uniform(outlier) - 1.0)};
  }
  std::normal_distribution<double> normal;
  const double factor = noise_.factor(scene.elapsed, truth[0]);
  const double range = truth[0] + factor * parameters_.sigma_range * normal(random);
  return {range, wrap_angle(truth[1] + factor * sigma_bearing_ * normal(random))};
}

mrpt::obs::CObservation::Ptr RangeBearingSensor::observe(const SensorScene& scene) {
  auto observation = CObservationBearingRange::Create();
  observation->timestamp = scene.stamp;
  observation->sensorLabel = "landmarks";
  observation->sensorLocationOnRobot = mount_.logged_pose();
  observation->fieldOfView_yaw = static_cast<float>(2.0 * half_view_);
  observation->fieldOfView_pitch = 0.0F;
  observation->maxSensorDistance = static_cast<float>(parameters_.max_range);
  observation->sensor_std_range = static_cast<float>(parameters_.sigma_range);
  observation->sensor_std_yaw = static_cast<float>(sigma_bearing_);
  const Eigen::Vector3d T_world_sensor = compose_poses(scene.T_world_robot, mount_.actual);
  for (std::size_t i = 0; i < scene.ids.size(); ++i) {
    const Eigen::Vector2d p_world = scene.p_world[i].head<2>();
    const Eigen::Vector2d p = transform_back(T_world_sensor, p_world);
    const Eigen::Vector2d truth(p.norm(), std::atan2(p.y(), p.x()));
    if (truth[0] > parameters_.max_range || std::abs(truth[1]) > half_view_) continue;
    if (!scene.walls.sees(T_world_sensor.head<2>(), p_world)) continue;
    const Eigen::Vector2d z = disturb(truth, scene, i);
    if (!(z[0] > 0.0)) continue;
    CObservationBearingRange::TMeasurement measurement{};
    measurement.range = static_cast<float>(z[0]);
    measurement.yaw = static_cast<float>(z[1]);
    measurement.landmarkID = static_cast<std::int32_t>(identities_ ? scene.ids[i] : kNoIdentity);
    observation->sensedData.push_back(measurement);
  }
  return observation;
}

}  // namespace libslam
