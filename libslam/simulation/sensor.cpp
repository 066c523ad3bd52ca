#include <libslam/simulation/beacon_sensor.hpp>
#include <libslam/simulation/laser_sensor.hpp>
#include <libslam/simulation/range_bearing_sensor.hpp>
#include <libslam/simulation/stereo_image_sensor.hpp>
#include <libslam/simulation/stereo_sensor.hpp>

namespace libslam {

std::vector<std::unique_ptr<SimulatedSensor>> make_sensors(const Scenario& scenario,
                                                           std::uint64_t seed) {
  std::vector<std::unique_ptr<SimulatedSensor>> sensors;
  if (scenario.range_bearing.enabled)
    sensors.push_back(std::make_unique<RangeBearingSensor>(scenario, seed));
  if (scenario.beacons.enabled) sensors.push_back(std::make_unique<BeaconSensor>(scenario, seed));
  if (scenario.laser.enabled) sensors.push_back(std::make_unique<LaserSensor>(scenario, seed));
  if (scenario.stereo.enabled) sensors.push_back(std::make_unique<StereoSensor>(scenario, seed));
  if (scenario.stereo_images.enabled)
    sensors.push_back(std::make_unique<StereoImageSensor>(scenario, seed));
  return sensors;
}

}  // namespace libslam
