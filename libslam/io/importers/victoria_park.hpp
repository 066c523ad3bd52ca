#pragma once
// Victoria Park, Sydney (Guivant, Nebot, 2001): a utility truck with an encoder on its rear left
// wheel, a steering encoder and a laser at the front; landmarks are tree trunks; GPS where it had
// fixes.

#include <libslam/io/importers/imported_log.hpp>

namespace libslam {

/// Falsification of the readings themselves: speed' = speed * speed, steering' = steering *
/// steering + bias.
struct AckermannDistortion {
  double speed = 1.0;
  double steering = 1.0;
  double bias = 0.0;  ///< [rad]
};

struct VictoriaParkOptions {
  enum class Association { kNone, kKnown, kIsam, kRawScans };
  enum class Steering { kAa3, kDrs };
  Association association = Association::kNone;
  Steering steering = Steering::kAa3;  ///< which of the two published calibrations
  double max_diameter = 2.0;           ///< trunks at least as thick are left out [m] (kNone)
  AckermannDistortion distortion;      ///< not for kIsam
};

/// `directory` is laid out as published with its sub-folders (tree_detections, known_association,
/// isam_gtsam, raw_ascii); files optionally with ".gz".
///
/// kNone: tree detections without identities. kRawScans: the scans of the laser themselves. kKnown:
/// observations whose identities were found off-line. kIsam: relative odometry and landmark
/// positions with covariances, as (action, frame) pairs with nominal times; see
/// `victoria_park_isam.cpp` for the reading of its noise columns.
///
/// Odometry: with alpha the steering angle and v_e the encoder speed, the rear axle centre moves at
/// v_c = v_e / (1 - tan(alpha) H / L) and turns at v_c tan(alpha) / L. A row is the mean since the
/// row before. The pose is that of the rear axle centre; the laser is L + a = 3.78 m ahead of it
/// and b = 0.5 m to the left. The path of the truth are the GPS fixes: positions only, in their own
/// frame. Throws InputError.
ImportedLog import_victoria_park(const std::string& directory, const VictoriaParkOptions& options);

/// The kIsam variant alone.
ImportedLog import_victoria_park_isam(const std::string& file);

}  // namespace libslam
