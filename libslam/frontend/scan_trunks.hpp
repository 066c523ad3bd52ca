#pragma once
// CObservation2DRangeScan -> trunks as range-bearing features.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <libslam/config/parameters.hpp>
#include <libslam/frontend/channel_numbers.hpp>
#include <libslam/frontend/frontend.hpp>
#include <libslam/frontend/trunk_detection.hpp>

namespace mrpt::obs {
class CObservation2DRangeScan;
}

namespace libslam {

/// z = (range, bearing) of the centre of a trunk (TrunkDetector) in the frame of the laser; its
/// noise is that of the detection, or the configured one (`measurement.noise: configured`). Objects
/// beyond min_range and max_range are no trunks, but still hide what is behind them. The sensor's
/// pose contributes x, y and yaw. Features have no identity.
class ScanTrunks final : public Frontend {
 public:
  ScanTrunks(const FrontendParameters& frontend, const MeasurementParameters& measurement,
             std::string sensor_label);
  void extract(const mrpt::obs::CSensoryFrame& frame, std::vector<FeatureBatch>& batches) override;
  bool needs_every_frame() const override { return false; }
  /// Scans without an aperture or with fewer than two beams.
  std::int64_t unusable() const override { return unusable_; }
  /// trunks_per_scan.
  std::map<std::string, double> figures() const override;

 private:
  FeatureBatch to_features(const mrpt::obs::CObservation2DRangeScan& scan);

  double min_range_, max_range_, range_bias_;
  MeasurementMatrix configured_;
  bool only_configured_;
  std::string sensor_label_;
  TrunkDetector detector_;
  ChannelNumbers channels_;
  std::vector<double> ranges_;
  std::vector<DetectedTrunk> trunks_;
  std::int64_t unusable_ = 0, scans_ = 0, found_ = 0;
};

}  // namespace libslam
