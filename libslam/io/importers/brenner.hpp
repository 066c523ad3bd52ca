#pragma once
// LEGO robot with a laser (C. Brenner, Univ. Hannover, SLAM lectures): ticks of two tracks, raw
// scans, six cylinders, positions from an overhead camera.

#include <string>

#include <libslam/io/importers/imported_log.hpp>

namespace libslam {

struct BrennerOptions {
  double metres_per_tick = 0.349e-3;  ///< nominal, both tracks [m]
  double track_width = 0.155;         ///< nominal [m]; the odometry poses are computed with it
  /// The stamps of scans and of camera positions are late by so much against those of the ticks
  /// [s]. Measured: with scans 0.3 to 0.5 s earlier the six cylinders appear as six landmarks, with
  /// the stamps as they are as 28; and the path fits the camera best with its stamps 0.2 s earlier.
  /// Here the ticks are shifted to the others, because no time is negative.
  double scan_delay = 0.4, camera_delay = 0.2;
};

/// `directory` holds robot4_motors.txt, robot4_scan.txt, robot4_reference.txt and
/// robot_arena_landmarks.txt, each optionally with ".gz". Pose: middle between the tracks; the
/// laser is 30 mm ahead of it. Path of the truth: positions of the laser, in the frame of the
/// arena; landmarks: centres of the cylinders, numbered from 0. Throws InputError.
ImportedLog import_brenner(const std::string& directory, const BrennerOptions& options);

}  // namespace libslam
