#pragma once
// What stands in a simulated world, and the way through it.

#include <vector>

#include <Eigen/Core>

#include <libslam/data/ground_truth.hpp>
#include <libslam/simulation/scenario.hpp>

namespace libslam {

/// A straight wall of no thickness, world frame [m].
struct Wall {
  Eigen::Vector2d from, to;
};

struct World {
  std::vector<TrueLandmark> landmarks;      ///< positions x, y[, z] [m] at the start
  std::vector<Eigen::Vector2d> way_points;  ///< one lap, in order [m]
  std::vector<Wall> walls;
  Eigen::Vector3d T_world_start = Eigen::Vector3d::Zero();  ///< x [m], y [m], phi [rad]
};

/// Landmarks scattered uniformly; a closed counter-clockwise lap about the centre, its way-points
/// between half of the way out and nine tenths of it. Starts at the first way-point.
World make_random_world(const WorldParameters& parameters);

/// A grid of rectangular rooms. Every wall between neighbours has a door in its middle; the lap
/// goes through all rooms row by row, and back the same way. Landmarks stand at random along the
/// walls of the rooms, not in doors.
World make_rooms(const WorldParameters& parameters);

}  // namespace libslam
