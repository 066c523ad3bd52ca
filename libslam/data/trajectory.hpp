#pragma once
// A path of a robot: estimated, true, or read from a file.

#include <vector>

#include <Eigen/Core>

#include <libslam/data/spatial_pose.hpp>

namespace libslam {

/// Poses (x [m], y [m], phi [rad]) of the robot in one fixed frame. `spatial` is either empty, then
/// the path is planar, or as long as `poses`, which are its shadow on the ground then.
///
/// `times` [s since 1970] is either empty, then poses belong to the steps of a log by order, or as
/// long as `poses` and non-decreasing. `has_heading` is false for positions only (GPS); phi is then
/// 0 and means nothing, and the positions are those of `point_on_robot`.
struct Trajectory {
  std::vector<double> times;
  std::vector<Eigen::Vector3d> poses;
  std::vector<SpatialPose> spatial;
  bool has_heading = true;
  Eigen::Vector2d point_on_robot = Eigen::Vector2d::Zero();  ///< x forward, y left [m]
};

}  // namespace libslam
