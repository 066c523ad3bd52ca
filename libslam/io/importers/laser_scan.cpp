#include <libslam/io/importers/laser_scan.hpp>

namespace libslam {

mrpt::obs::CObservation2DRangeScan to_range_scan(const LaserGeometry& laser, double time,
                                                 std::span<const float> ranges) {
  mrpt::obs::CObservation2DRangeScan scan;
  scan.timestamp = mrpt::Clock::fromDouble(time);
  scan.sensorLabel = "laser";
  const double aperture =
      ranges.empty() ? 0.0 : laser.resolution * static_cast<double>(ranges.size() - 1);
  const Eigen::Vector3d& mount = laser.T_robot_sensor;
  scan.sensorPose = mrpt::poses::CPose3D(
      mount.x(), mount.y(), 0.0, mount.z() + laser.first_bearing + 0.5 * aperture, 0.0, 0.0);
  scan.rightToLeft = true;
  scan.aperture = static_cast<float>(aperture);
  scan.maxRange = static_cast<float>(laser.max_range);
  scan.stdError = static_cast<float>(laser.sigma_range);
  scan.resizeScan(ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const auto range = static_cast<double>(ranges[i]);
    scan.setScanRange(i, ranges[i]);
    scan.setScanRangeValidity(i, range > 0.0 && range < laser.max_range);
  }
  return scan;
}

}  // namespace libslam
