#pragma once
// Range and bearing of landmarks -> CObservationBearingRange.

#include <libslam/simulation/sensor_noise.hpp>

namespace libslam {

/// Sees the landmarks within range and field of view that no wall hides, by their true place. A
/// range that noise makes zero or negative is not reported.
class RangeBearingSensor final : public SimulatedSensor {
 public:
  RangeBearingSensor(const Scenario& scenario, std::uint64_t seed);
  mrpt::obs::CObservation::Ptr observe(const SensorScene& scene) override;

 private:
  /// Range [m] and bearing [rad] as measured; now and then an outlier.
  Eigen::Vector2d disturb(const Eigen::Vector2d& truth, const SensorScene& scene,
                          std::size_t landmark) const;

  RangeBearingSensorParameters parameters_;
  SensorMount mount_;
  SensorNoise noise_;
  bool identities_;
  double sigma_bearing_, half_view_;  ///< [rad]
};

}  // namespace libslam
