#pragma once
// One odometry step as it leaves the log: what the robot says it did since the previous step.

#include <optional>

#include <Eigen/Core>

namespace libslam {

/// Odometry over the interval (time - dt, time]. Frame: the robot frame at the start of the
/// interval (x forward, y left). SI units, radians. Optional fields are present only when the log
/// carries them and they passed the sanity check of `frontend/odometry`.
struct MotionAction {
  double time = 0.0;  ///< end of the interval [s]
  double dt = 0.0;    ///< length of the interval [s], 0 if unknown
  Eigen::Vector3d increment = Eigen::Vector3d::Zero();  ///< dx [m], dy [m], dphi [rad]
  std::optional<Eigen::Matrix3d> cov_increment;         ///< covariance of `increment`
  std::optional<Eigen::Vector2d> velocity;              ///< mean v [m/s], omega [rad/s] over dt
  std::optional<Eigen::Vector2d> ticks;                 ///< encoder ticks left, right over dt [1]
  /// Mean velocity of the body over dt in its own frame: vx, vy, vz [m/s], wx, wy, wz [rad/s].
  std::optional<Eigen::Matrix<double, 6, 1>> twist;
  double hold = 0.0;  ///< time for which the reading behind `twist` holds [s], of which dt is a
                      ///< part; 0: dt
};

}  // namespace libslam
