#include <Eigen/Geometry>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <libslam/frontend/scan_lines.hpp>

namespace libslam {

namespace {
using Scan = mrpt::obs::CObservation2DRangeScan;
}  // namespace

ScanLines::ScanLines(const FrontendParameters& parameters, std::string sensor_label)
    : parameters_(parameters),
      sensor_label_(std::move(sensor_label)),
      extraction_(parameters.lines) {}

bool ScanLines::accepts(const Scan& scan) {
  if (is_level(scan)) return true;
  ++unusable_;
  if (warnings_.empty())
    warnings_.push_back("scanner '" + scan.sensorLabel + "' is tilted by pitch " +
                        std::to_string(scan.sensorPose.pitch()) + ", roll " +
                        std::to_string(scan.sensorPose.roll()) + " rad; its scans are left out");
  return false;
}

void ScanLines::extract(const mrpt::obs::CSensoryFrame& frame, std::vector<FeatureBatch>& batches) {
  std::size_t count = 0;
  surface_.clear();
  for (const auto& any : frame) {
    const auto* scan = dynamic_cast<const Scan*>(any.get());
    if (scan == nullptr || (!sensor_label_.empty() && scan->sensorLabel != sensor_label_)) continue;
    if (!accepts(*scan)) continue;
    if (batches.size() == count) batches.emplace_back();
    FeatureBatch& batch = batches[count++];
    batch.clear();
    unusable_ += read_beam_points(*scan, {parameters_.min_range, parameters_.max_range}, points_);
    const auto& on_robot = scan->sensorPose;
    const Eigen::Rotation2Dd turn(on_robot.yaw());
    for (const BeamPoint& point : points_)
      surface_.emplace_back(turn * point.p + Eigen::Vector2d(on_robot.x(), on_robot.y()));
    for (const ExtractedLine& line : extraction_.extract(points_, beam_spacing(*scan))) {
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
