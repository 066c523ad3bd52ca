#include <cmath>
#include <utility>

#include <mrpt/obs/CObservationOdometry.h>

#include <libslam/frontend/sensor_path_observation.hpp>

namespace libslam {

SensorPathObservation::SensorPathObservation(const MeasurementParameters& measurement,
                                             std::string sensor_label)
    : sensor_label_(std::move(sensor_label)) {
  const double xy = measurement.sigma_displacement_xy;
  const double heading = measurement.sigma_displacement_heading_deg * kPi / 180.0;
  cov_ = Eigen::Vector3d(xy * xy, xy * xy, heading * heading).asDiagonal();
}

void SensorPathObservation::extract(const mrpt::obs::CSensoryFrame& frame,
                                    std::vector<FeatureBatch>& batches) {
  batches.clear();
  for (const auto& any : frame) {
    const auto* reading = dynamic_cast<const mrpt::obs::CObservationOdometry*>(any.get());
    if (reading == nullptr || reading->sensorLabel != sensor_label_) continue;
    const Eigen::Vector3d pose(reading->odometry.x(), reading->odometry.y(),
                               reading->odometry.phi());
    if (!pose.allFinite()) {
      ++unusable_;
      continue;
    }
    Feature feature;
    feature.z = pose;
    feature.cov = cov_;
    batches.push_back({feature});
  }
}

}  // namespace libslam
