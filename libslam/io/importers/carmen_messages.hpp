#pragma once
// The messages of a CARMEN log that carry odometry and laser scans.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <libslam/io/importers/laser_scan.hpp>
#include <libslam/io/text_reader.hpp>

namespace libslam {

/// One message. Poses: x [m], y [m], phi [rad] in the odometry frame.
struct CarmenMessage {
  std::int64_t line = 0;
  double time = 0.0;                                ///< ipc time stamp [s]
  Eigen::Vector3d robot = Eigen::Vector3d::Zero();  ///< pose of the robot
  std::vector<float> ranges;                        ///< [m]; empty: odometry alone
  LaserGeometry laser;                              ///< of a scan
  bool is_scan() const { return !ranges.empty(); }
};

/// Reads the current row:
///   FLASER n r_1..r_n x y phi odom_x odom_y odom_phi ipc_time ...
///   ROBOTLASER1 kind first_bearing field_of_view resolution max_range accuracy remission n
///   r_1..r_n
///     m e_1..e_m laser_x laser_y laser_phi x y phi v omega forward side turn ipc_time ...
///   ODOM x y phi v omega acceleration ipc_time ...
/// Nothing where it is another message. The beams of FLASER begin at -90 degrees, 1 degree apart
/// where there are 180 or 181 of them, 1/2 degree where 360 or 361, 1/4 degree where 720 or 721.
/// Where the laser sits on the robot follows from its two poses. `max_range` [m] bounds that of the
/// message. Throws InputError where a number cannot be read or the count of beams is another.
std::optional<CarmenMessage> read_carmen_message(const TextReader& row, double max_range);

}  // namespace libslam
