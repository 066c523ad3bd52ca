#include <cmath>
#include <limits>

#include <mrpt/obs/CObservation2DRangeScan.h>

#include <libslam/frontend/scan_trunks.hpp>

namespace libslam {

namespace {

using Scan = mrpt::obs::CObservation2DRangeScan;

/// Counter-clockwise, infinite where nothing came back.
void read_ranges(const Scan& scan, double bias, std::vector<double>& ranges) {
  const std::size_t n = scan.getScanSize();
  ranges.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double range = scan.getScanRange(i) - bias;
    const bool hit = scan.getScanRangeValidity(i) && std::isfinite(range) && range > 0.0;
    ranges[scan.rightToLeft ? i : n - 1 - i] =
        hit ? range : std::numeric_limits<double>::infinity();
  }
}

bool usable(const Scan& scan) {
  constexpr double kFullTurn = 6.2832;
  return scan.getScanSize() >= 2 && scan.aperture > 0.0F && scan.aperture < kFullTurn;
}

}  // namespace

ScanTrunks::ScanTrunks(const FrontendParameters& frontend, const MeasurementParameters& measurement,
                       std::string sensor_label)
    : min_range_(frontend.min_range),
      max_range_(frontend.max_range),
      range_bias_(frontend.trunks.range_bias),
      configured_(
          Eigen::Vector2d(measurement.sigma_range, measurement.sigma_bearing_deg * kPi / 180.0)
              .cwiseAbs2()
              .asDiagonal()),
      only_configured_(measurement.noise == "configured"),
      sensor_label_(std::move(sensor_label)),
      detector_(frontend.trunks) {}

void ScanTrunks::extract(const mrpt::obs::CSensoryFrame& frame,
                         std::vector<FeatureBatch>& batches) {
  batches.clear();
  for (const auto& any : frame) {
    const auto* scan = dynamic_cast<const Scan*>(any.get());
    if (scan == nullptr) continue;
    if (!sensor_label_.empty() && scan->sensorLabel != sensor_label_) continue;
    if (!usable(*scan)) {
      ++unusable_;
      continue;
    }
    read_ranges(*scan, range_bias_, ranges_);
    const double aperture = scan->aperture;
    detector_.detect({ranges_, -0.5 * aperture, aperture / static_cast<double>(ranges_.size() - 1)},
                     trunks_);
    FeatureBatch batch = to_features(*scan);
    ++scans_;
    found_ += static_cast<std::int64_t>(batch.size());
    if (!batch.empty()) batches.push_back(std::move(batch));
  }
}

FeatureBatch ScanTrunks::to_features(const Scan& scan) {
  FeatureBatch batch;
  batch.reserve(trunks_.size());
  const int channel = channels_.of(scan.sensorLabel);
  for (const DetectedTrunk& trunk : trunks_) {
    if (trunk.range < min_range_ || trunk.range > max_range_) continue;
    Feature& feature = batch.emplace_back();
    feature.channel = channel;
    feature.z = Eigen::Vector2d(trunk.range, trunk.bearing);
    feature.cov = only_configured_ ? configured_ : MeasurementMatrix(trunk.cov);
    feature.T_robot_sensor = {scan.sensorPose.x(), scan.sensorPose.y(), scan.sensorPose.yaw()};
  }
  return batch;
}

std::map<std::string, double> ScanTrunks::figures() const {
  if (scans_ == 0) return {};
  return {{"trunks_per_scan", static_cast<double>(found_) / static_cast<double>(scans_)}};
}

}  // namespace libslam
