#pragma once
// The surfaces that a laser scan shows: its points in the frame of the robot, with their normals.
//
// A normal is that of the line through a point and its neighbours on both sides, by total least
// squares over all within 15 cm and two at least, up to a jump. At a corner or in clutter, where no
// straight line fits, a point has none.

#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/frontend/beam_points.hpp>

namespace libslam {

struct SurfacePoint {
  Eigen::Vector2d p;      ///< [m], frame of the robot
  double bearing = 0.0;   ///< around the sensor, in the direction of the robot's axes [rad]
  bool smooth = false;    ///< the rest is known
  Eigen::Vector2d n;      ///< unit normal, away from the sensor
  Eigen::Vector2d foot;   ///< a point of the line: the mean of the neighbours [m]
  double var_turn = 0.0;  ///< variance of the direction of n [rad^2]
};

/// Overwrites `surface` with all `points`, in their order. `T_robot_sensor`: x [m], y [m], phi.
void find_surface(std::span<const BeamPoint> points, const Eigen::Vector3d& T_robot_sensor,
                  std::vector<SurfacePoint>& surface);

}  // namespace libslam
