#pragma once
// CObservationOdometry of a sensor (scan matching, visual odometry) -> readings of its own path.

#include <cstdint>
#include <string>

#include <libslam/config/parameters.hpp>
#include <libslam/frontend/frontend.hpp>

namespace libslam {

/// One batch of one feature per reading: z is the pose of the sensor (x [m], y [m], phi [rad]) on
/// the path that it reports, whose origin and drift mean nothing; only what lies between two
/// readings does. Poses instead of increments, so that a reading that was left out (schedule,
/// defect) lengthens the next displacement and is not lost. The covariance is that of one
/// displacement, whatever its length: `measurement.sigma_displacement_xy` and `_heading_deg`.
class SensorPathObservation final : public Frontend {
 public:
  /// Reads the observations labelled `sensor_label`; the robot's own odometry has another label.
  SensorPathObservation(const MeasurementParameters& measurement, std::string sensor_label);
  void extract(const mrpt::obs::CSensoryFrame& frame, std::vector<FeatureBatch>& batches) override;
  std::int64_t unusable() const override { return unusable_; }

 private:
  MeasurementMatrix cov_;
  std::string sensor_label_;
  std::int64_t unusable_ = 0;
};

}  // namespace libslam
