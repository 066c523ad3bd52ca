#pragma once
// Simultaneous calibration of odometry and sensor parameters (Censi, Franchi, Marchionni, Oriolo,
// IEEE T-RO 29(2), 2013): a Khepera III with a laser in three mountings; wheel velocities and
// scan-matched displacements of the laser.

#include <string>

#include <libslam/io/importers/imported_log.hpp>

namespace libslam {

struct CensiOptions {
  std::string subset = "lstraight";  ///< mounting lstraight, l90 or lmov; _0, _1, _2: its thirds
  double nominal_radius = 0.023;     ///< of both wheels, what the robot believes [m]
  double nominal_track = 0.080;      ///< between the wheels, what the robot believes [m]
};

/// Reads `directory`/csv/<subset>.csv (T, phi_l, phi_r, sm_x, sm_y, sm_theta in s, rad/s, m, rad;
/// optionally ".gz") and results/<subset>_results.json. Throws InputError.
///
/// (action, frame) pairs: the odometry that the nominal geometry makes of the wheel velocities, and
/// the path of the laser, composed of its displacements. True calibration: the published batch
/// result, as factors scale_left, scale_right and track_width on the nominal geometry, and the pose
/// sensor_x, sensor_y, sensor_phi of the laser; `parameters` holds the published standard
/// deviations as published_sigma_<name>.
///
/// Covariance of an increment: one step of the encoders per wheel, and what the wheels may do in
/// 0.1 s of their change of speed. Wheels and scans were timed by two clocks: where a wheel starts
/// or stops the scan-matched displacement is up to 0.13 s of the new speed ahead of the wheels;
/// where the speed is constant nothing shows.
ImportedLog import_censi(const std::string& directory, const CensiOptions& options);

}  // namespace libslam
