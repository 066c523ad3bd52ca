#pragma once
// Raw scans of a planar laser as MRPT keeps them.

#include <span>
#include <string>

#include <Eigen/Core>
#include <mrpt/obs/CObservation2DRangeScan.h>

namespace libslam {

/// A laser that scans counter-clockwise: beam i looks along first_bearing + i * resolution in the
/// frame T_robot_sensor.
struct LaserGeometry {
  double first_bearing = 0.0;  ///< [rad]
  double resolution = 0.0;     ///< between two beams [rad]
  double max_range = 0.0;      ///< a range at least as long is no return [m]
  double sigma_range = 0.01;   ///< [m]
  Eigen::Vector3d T_robot_sensor = Eigen::Vector3d::Zero();  ///< x [m], y [m], phi [rad]
};

/// MRPT's scans are symmetric: its sensor looks along the middle beam. Ranges [m] that are not
/// positive or not below max_range are kept and marked as no return. `time` [s since 1970].
mrpt::obs::CObservation2DRangeScan to_range_scan(const LaserGeometry& laser, double time,
                                                 std::span<const float> ranges);

}  // namespace libslam
