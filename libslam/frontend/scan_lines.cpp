#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <libslam/frontend/scan_lines.hpp>

namespace libslam {

namespace {

using Scan = mrpt::obs::CObservation2DRangeScan;

/// Beams of a sensor that is tilted by this [rad] are longer than their shadows by half a percent.
constexpr double kLargestTilt = 0.1;

}  // namespace

ScanLines::ScanLines(const FrontendParameters& parameters, std::string sensor_label)
    : parameters_(parameters),
      sensor_label_(std::move(sensor_label)),
      extraction_(parameters.lines) {}

bool ScanLines::is_level(const Scan& scan) {
  const double pitch = scan.sensorPose.pitch(), roll = scan.sensorPose.roll();
  if (std::abs(pitch) < kLargestTilt && std::abs(std::sin(roll)) < kLargestTilt) return true;
  ++unusable_;
  if (warnings_.empty())
    warnings_.push_back("scanner '" + scan.sensorLabel + "' is tilted by pitch " +
                        std::to_string(pitch) + ", roll " + std::to_string(roll) +
                        " rad; its scans are left out");
  return false;
}

double ScanLines::read_points(const Scan& scan) {
  const std::size_t beams = scan.getScanSize();
  const bool upside_down = std::cos(scan.sensorPose.roll()) < 0.0;
  const bool counterclockwise = scan.rightToLeft != upside_down;
  const double step = beams > 1 ? scan.aperture / static_cast<double>(beams - 1) : 0.0;
  points_.clear();
  points_.reserve(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const std::size_t beam = counterclockwise ? i : beams - 1 - i;
    const double range = scan.getScanRange(beam);
    if (!scan.getScanRangeValidity(beam)) continue;
    if (!std::isfinite(range) || range <= 0.0) {
      ++unusable_;
      continue;
    }
    if (range < parameters_.min_range || range > parameters_.max_range || range >= scan.maxRange)
      continue;
    const double bearing = static_cast<double>(i) * step - 0.5 * scan.aperture;
    points_.push_back({range, bearing, {range * std::cos(bearing), range * std::sin(bearing)}});
  }
  return step;
}

void ScanLines::extract(const mrpt::obs::CSensoryFrame& frame, std::vector<FeatureBatch>& batches) {
  std::size_t count = 0;
  surface_.clear();
  for (const auto& any : frame) {
    const auto* scan = dynamic_cast<const Scan*>(any.get());
    if (scan == nullptr || (!sensor_label_.empty() && scan->sensorLabel != sensor_label_)) continue;
    if (!is_level(*scan)) continue;
    if (batches.size() == count) batches.emplace_back();
    FeatureBatch& batch = batches[count++];
    batch.clear();
    const double step = read_points(*scan);
    const auto& on_robot = scan->sensorPose;
    const Eigen::Rotation2Dd turn(on_robot.yaw());
    for (const BeamPoint& point : points_)
      surface_.emplace_back(turn * point.p + Eigen::Vector2d(on_robot.x(), on_robot.y()));
    for (const ExtractedLine& line : extraction_.extract(points_, step)) {
      Feature& feature = batch.emplace_back();
      feature.channel = channels_.of(scan->sensorLabel);
      feature.z = Eigen::Vector2d(line.alpha, line.r);
      feature.cov = line.cov;
      feature.T_robot_sensor = {on_robot.x(), on_robot.y(), on_robot.yaw()};
      feature.extent = line.extent;
    }
    ++scans_;
    lines_ += static_cast<std::int64_t>(batch.size());
  }
  batches.resize(count);
}

std::map<std::string, double> ScanLines::figures() const {
  if (scans_ == 0) return {};
  const auto scans = static_cast<double>(scans_);
  return {{"scans", scans}, {"mean_lines", static_cast<double>(lines_) / scans}};
}

}  // namespace libslam
