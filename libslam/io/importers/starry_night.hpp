#pragma once
// "Starry Night" of UTIAS: a stereo camera with gyros, moved by hand over 20 infrared markers,
// Vicon truth (T. Barfoot, State Estimation for Robotics, data set 3).

#include <libslam/io/importers/spatial_log.hpp>

namespace libslam {

/// `directory` holds groundtruth_and_imu.csv, stereo_observations.csv, landmarks.csv and
/// params.txt, each optionally with ".gz".
///
/// The robot is the vehicle frame of the data set, the world that of Vicon. The velocities of row
/// k - 1 move the camera from pose k - 1 to pose k. Standard deviations of velocities, turn rates
/// and pixels are among the parameters. Throws InputError.
SpatialLog import_starry_night(const std::string& directory);

/// Standard deviations (left u, left v, right u, right v [px]) that the data set states.
Eigen::Vector4d starry_night_sigma(const SpatialLog& log);

}  // namespace libslam
