#pragma once
// Which field of an odometry step drives a motion model (`input.odometry`).

#include <Eigen/Core>

#include <libslam/config/parameters.hpp>
#include <libslam/data/motion_action.hpp>

namespace libslam {

enum class OdometrySource {
  kIncrements,  ///< pose increments; also what `auto` means
  kVelocities,  ///< v and omega, constant over dt
  kTicks,       ///< encoder ticks of the left and the right wheel
};

/// Throws std::invalid_argument with the offending value if `input.odometry` names no source.
OdometrySource odometry_source(const InputParameters& input);

/// True if the velocities of `action` are what moves the robot. A velocity says nothing without an
/// interval: with dt = 0 the action's own increment is taken instead. Throws std::invalid_argument
/// if velocities are asked for and absent.
bool uses_velocity(const MotionAction& action, OdometrySource source);

/// Movement (ds, e, dphi) of an action along an exact arc (arc.hpp): through its pose increment, or
/// (v dt, 0, omega dt). Throws std::invalid_argument if velocities are asked for and absent.
Eigen::Vector3d movement_of(const MotionAction& action, OdometrySource source);

/// Ticks left, right of an action; throws std::invalid_argument if it has none.
Eigen::Vector2d ticks_of(const MotionAction& action);

}  // namespace libslam
