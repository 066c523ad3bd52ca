#pragma once
// Tracked stereo points and velocities of KITTI drives, as prepared for a course of UCSD
// (N. Atanasov, ECE276A), with the poses of the KITTI odometry benchmark (Geiger et al., CVPR
// 2012).

#include <libslam/io/importers/spatial_log.hpp>

namespace libslam {

/// `directory` holds stereo_features.csv, imu_velocity.csv and calib.txt of one drive, and where
/// known gt_poses_seqNN.txt, each optionally with ".gz".
///
/// The robot is the frame of the IMU (x forward, y left, z up), the world the robot at frame 0. The
/// velocities of row k move the robot from frame k - 1 to frame k: rows shifted by one fit worse.
/// Poses beyond the frames of the drive, and points of frames without velocities, are left out.
/// Throws InputError.
SpatialLog import_kitti_features(const std::string& directory);

}  // namespace libslam
