#include <mrpt/obs/CObservationBeaconRanges.h>

#include <libslam/data/feature.hpp>
#include <libslam/simulation/beacon_sensor.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

using mrpt::obs::CObservationBeaconRanges;

BeaconSensor::BeaconSensor(const Scenario& scenario, std::uint64_t seed)
    : parameters_(scenario.beacons),
      mount_(parameters_.pose, scenario.truth),
      noise_(scenario.faults, seed, RandomPurpose::kBeacons, RandomPurpose::kBeaconsOutlier),
      identities_(scenario.log.identities) {}

mrpt::obs::CObservation::Ptr BeaconSensor::observe(const SensorScene& scene) {
  auto observation = CObservationBeaconRanges::Create();
  observation->timestamp = scene.stamp;
  observation->sensorLabel = "beacons";
  observation->minSensorDistance = 0.0F;
  observation->maxSensorDistance = static_cast<float>(parameters_.max_range);
  observation->stdError = static_cast<float>(parameters_.sigma_range);
  const Eigen::Vector2d p_antenna = transform_point(scene.T_world_robot, mount_.actual.head<2>());
  const Eigen::Vector3d p_world_antenna(p_antenna.x(), p_antenna.y(), parameters_.antenna_height);
  for (std::size_t i = 0; i < scene.ids.size(); ++i) {
    const double distance = (scene.p_world[i] - p_world_antenna).norm();
    if (distance > parameters_.max_range) continue;
    RandomStream random = noise_.stream(scene, i);
    const double sigma = noise_.factor(scene.elapsed, distance) * parameters_.sigma_range;
    double range = distance + sigma * std::normal_distribution<double>()(random);
    RandomStream outlier = noise_.outlier_stream(scene, i);
    if (noise_.draw_outlier(outlier))
      range = std::uniform_real_distribution<double>(0.0, parameters_.max_range)(outlier);
    if (!(range > 0.0)) continue;
    CObservationBeaconRanges::TMeasurement measurement;
    measurement.sensorLocationOnRobot = {mount_.logged.x(), mount_.logged.y(),
                                         parameters_.antenna_height};
    measurement.sensedDistance = static_cast<float>(range);
    measurement.beaconID = static_cast<std::int32_t>(identities_ ? scene.ids[i] : kNoIdentity);
    observation->sensedData.push_back(measurement);
  }
  return observation;
}

}  // namespace libslam
