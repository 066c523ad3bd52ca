#pragma once
// CObservationBearingRange -> range-bearing features.

#include <cstdint>
#include <string>
#include <vector>

#include <libslam/config/parameters.hpp>
#include <libslam/frontend/channel_numbers.hpp>
#include <libslam/frontend/frontend.hpp>

namespace libslam {

/// Noise of a feature: covariance of the observation where the log has one (validCovariances), else
/// the sensor sigmas of the log where positive, else the configured sigmas; `measurement.noise:
/// configured` takes the configured ones always. Elevation is projected out: range * cos(pitch);
/// the sensor's pose contributes x, y and yaw.
class RangeBearingObservation final : public Frontend {
 public:
  /// `with_identities` false: features carry none, whatever the log says.
  RangeBearingObservation(const FrontendParameters& frontend,
                          const MeasurementParameters& measurement, std::string sensor_label,
                          bool with_identities);
  void extract(const mrpt::obs::CSensoryFrame& frame, std::vector<FeatureBatch>& batches) override;
  std::int64_t unusable() const override { return unusable_; }

 private:
  FrontendParameters frontend_;
  MeasurementMatrix configured_;
  bool only_configured_, with_identities_;
  std::string sensor_label_;
  ChannelNumbers channels_;
  std::int64_t unusable_ = 0;
};

}  // namespace libslam
