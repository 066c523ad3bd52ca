#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <mrpt/obs/CObservationBearingRange.h>

#include <libslam/frontend/range_bearing_observation.hpp>

namespace libslam {

namespace {

using Observation = mrpt::obs::CObservationBearingRange;

Eigen::Matrix2d diagonal(double sigma_range, double sigma_bearing) {
  return Eigen::Vector2d(sigma_range * sigma_range, sigma_bearing * sigma_bearing).asDiagonal();
}

/// Positive definite and finite.
bool usable(const Eigen::Matrix2d& cov) {
  return cov.allFinite() && cov(0, 0) > 0.0 && cov.determinant() > 0.0;
}

MeasurementMatrix noise_of(const Observation& observation,
                           const Observation::TMeasurement& measured,
                           const MeasurementMatrix& configured) {
  if (observation.validCovariances) {
    const Eigen::Matrix2d cov = measured.covariance.asEigen().topLeftCorner<2, 2>();
    if (usable(cov)) return cov;
  } else if (observation.sensor_std_range > 0.0f && observation.sensor_std_yaw > 0.0f) {
    return diagonal(observation.sensor_std_range, observation.sensor_std_yaw);
  }
  return configured;
}

}  // namespace

RangeBearingObservation::RangeBearingObservation(const FrontendParameters& frontend,
                                                 const MeasurementParameters& measurement,
                                                 std::string sensor_label, bool with_identities)
    : frontend_(frontend),
      configured_(diagonal(measurement.sigma_range, measurement.sigma_bearing_deg * kPi / 180.0)),
      only_configured_(measurement.noise == "configured"),
      with_identities_(with_identities),
      sensor_label_(std::move(sensor_label)) {}

void RangeBearingObservation::extract(const mrpt::obs::CSensoryFrame& frame,
                                      std::vector<FeatureBatch>& batches) {
  batches.clear();
  for (const auto& any : frame) {
    const auto* observation = dynamic_cast<const Observation*>(any.get());
    if (observation == nullptr) continue;
    if (!sensor_label_.empty() && observation->sensorLabel != sensor_label_) continue;
    const auto& on_robot = observation->sensorLocationOnRobot;
    const int channel = channels_.of(observation->sensorLabel);
    FeatureBatch batch;
    batch.reserve(observation->sensedData.size());
    for (const auto& measured : observation->sensedData) {
      const double range = measured.range * std::cos(measured.pitch);
      if (!std::isfinite(range) || !std::isfinite(measured.yaw) || range <= 0.0) {
        ++unusable_;
        continue;
      }
      if (range < frontend_.min_range || range > frontend_.max_range) continue;
      Feature& feature = batch.emplace_back();
      const bool identified = with_identities_ && measured.landmarkID >= 0;
      feature.id = identified ? measured.landmarkID : kNoIdentity;
      feature.channel = channel;
      feature.z = Eigen::Vector2d(range, measured.yaw);
      feature.cov = only_configured_ ? configured_ : noise_of(*observation, measured, configured_);
      feature.T_robot_sensor = {on_robot.x(), on_robot.y(), on_robot.yaw()};
    }
    if (!batch.empty()) batches.push_back(std::move(batch));
  }
}

}  // namespace libslam
