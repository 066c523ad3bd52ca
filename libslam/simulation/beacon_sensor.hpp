#pragma once
// Ranges to radio beacons -> CObservationBeaconRanges.

#include <libslam/simulation/sensor_noise.hpp>

namespace libslam {

/// Hears every landmark within range, walls or not; the range is that in space, from the antenna.
class BeaconSensor final : public SimulatedSensor {
 public:
  BeaconSensor(const Scenario& scenario, std::uint64_t seed);
  mrpt::obs::CObservation::Ptr observe(const SensorScene& scene) override;

 private:
  BeaconSensorParameters parameters_;
  SensorMount mount_;
  SensorNoise noise_;
  bool identities_;
};

}  // namespace libslam
