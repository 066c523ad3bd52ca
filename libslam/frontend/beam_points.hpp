#pragma once
// CObservation2DRangeScan -> the ends of its beams, by increasing bearing.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace mrpt::obs {
class CObservation2DRangeScan;
}

namespace libslam {

/// One end of a beam, in the frame of the sensor.
struct BeamPoint {
  double range = 0.0, bearing = 0.0;  ///< [m], [rad]
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
};

/// Which echoes count [m].
struct RangeLimits {
  double min = 0.0, max = 0.0;
};

/// True if the scanner sees in a plane parallel to the ground, either side up.
bool is_level(const mrpt::obs::CObservation2DRangeScan& scan);

/// Angle between two beams [rad]; 0 of a single one.
double beam_spacing(const mrpt::obs::CObservation2DRangeScan& scan);

/// Overwrites `points` with the echoes between the limits. Beams without an echo are left out in
/// silence; returns how many were not finite or not positive though they claim to be valid.
std::int64_t read_beam_points(const mrpt::obs::CObservation2DRangeScan& scan,
                              const RangeLimits& limits, std::vector<BeamPoint>& points);

}  // namespace libslam
