#include <cmath>

#include <mrpt/obs/CObservation2DRangeScan.h>

#include <libslam/frontend/beam_points.hpp>

namespace libslam {

namespace {

using Scan = mrpt::obs::CObservation2DRangeScan;

/// Beams of a sensor that is tilted by this [rad] are longer than their shadows by half a percent.
constexpr double kLargestTilt = 0.1;

}  // namespace

bool is_level(const Scan& scan) {
  return std::abs(scan.sensorPose.pitch()) < kLargestTilt &&
         std::abs(std::sin(scan.sensorPose.roll())) < kLargestTilt;
}

double beam_spacing(const Scan& scan) {
  const std::size_t beams = scan.getScanSize();
  return beams > 1 ? scan.aperture / static_cast<double>(beams - 1) : 0.0;
}

std::int64_t read_beam_points(const Scan& scan, const RangeLimits& limits,
                              std::vector<BeamPoint>& points) {
  const std::size_t beams = scan.getScanSize();
  const bool upside_down = std::cos(scan.sensorPose.roll()) < 0.0;
  const bool counterclockwise = scan.rightToLeft != upside_down;
  const double step = beam_spacing(scan);
  std::int64_t unusable = 0;
  points.clear();
  points.reserve(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const std::size_t beam = counterclockwise ? i : beams - 1 - i;
    const double range = scan.getScanRange(beam);
    if (!scan.getScanRangeValidity(beam)) continue;
    if (!std::isfinite(range) || range <= 0.0) {
      ++unusable;
      continue;
    }
    if (range < limits.min || range > limits.max || range >= scan.maxRange) continue;
    const double bearing = static_cast<double>(i) * step - 0.5 * scan.aperture;
    points.push_back({range, bearing, {range * std::cos(bearing), range * std::sin(bearing)}});
  }
  return unusable;
}

}  // namespace libslam
