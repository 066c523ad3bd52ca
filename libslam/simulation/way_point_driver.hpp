#pragma once
// Steers to one way-point after the other, with the limits of a real vehicle.

#include <vector>

#include <Eigen/Core>

#include <libslam/simulation/scenario.hpp>

namespace libslam {

/// An ackermann vehicle drives at constant speed and turns its wheels towards the way-point no
/// faster than its steering rate and no further than its limit (compute_steering of Bailey's
/// simulator). The others turn at a rate proportional to the heading error, within the limit, and
/// slow down with its cosine: with the way-point behind them they turn on the spot.
class WayPointDriver {
 public:
  /// Throws std::invalid_argument without way-points.
  WayPointDriver(const DriveParameters& drive, const MotionParameters& motion,
                 std::vector<Eigen::Vector2d> way_points);

  /// Passes the way-points that `T_world_robot` has reached; true once all laps are done.
  bool arrive(const Eigen::Vector3d& T_world_robot);
  /// Command for the next `dt` [s]: speed [m/s] and turn rate [rad/s] of the nominal axle centre.
  Eigen::Vector2d command(const Eigen::Vector3d& T_world_robot, double dt);

  /// Way-points reached, all laps counted.
  std::size_t reached() const { return reached_; }
  double progress() const;
  /// Length of all laps from `start` [m].
  double length_from(const Eigen::Vector2d& start) const;

 private:
  const Eigen::Vector2d& target() const { return way_points_[reached_ % way_points_.size()]; }
  std::size_t total() const { return way_points_.size() * static_cast<std::size_t>(drive_.laps); }

  DriveParameters drive_;
  bool steers_;
  double wheelbase_;
  std::vector<Eigen::Vector2d> way_points_;
  std::size_t reached_ = 0;
  double steering_ = 0.0;  ///< [rad]
};

}  // namespace libslam
