#pragma once
// Planar motion at constant body velocity: the exponential of SE(2) and its inverse.
// (MRPT's Lie::SE<2> maps are retractions, not the exponential: an arc would not stay an arc.)

#include <Eigen/Core>

namespace libslam {

/// Pose change dx [m], dy [m], dphi [rad] in the frame at the start of a motion whose arc (velocity
/// times duration: forward [m], sideways [m], turn [rad]) is given.
Eigen::Vector3d increment_of_arc(const Eigen::Vector3d& arc);

/// Inverse of `increment_of_arc` for turns in (-pi, pi].
Eigen::Vector3d arc_of_increment(const Eigen::Vector3d& increment);

/// Part `s` in [0, 1] of a motion at constant velocity. Parts that sum to 1 compose to the whole.
inline Eigen::Vector3d part_of_motion(const Eigen::Vector3d& increment, double s) {
  return increment_of_arc(s * arc_of_increment(increment));
}

}  // namespace libslam
