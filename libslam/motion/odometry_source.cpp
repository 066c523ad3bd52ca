#include <stdexcept>
#include <string>

#include <libslam/motion/arc.hpp>
#include <libslam/motion/odometry_source.hpp>

namespace libslam {

namespace {

[[noreturn]] void throw_absent(const MotionAction& action, const char* field) {
  throw std::invalid_argument(std::string("odometry step at ") + std::to_string(action.time) +
                              " s has no " + field + ", which the motion model is configured for");
}

}  // namespace

OdometrySource odometry_source(const InputParameters& input) {
  if (input.odometry == "auto" || input.odometry == "increments")
    return OdometrySource::kIncrements;
  if (input.odometry == "velocities") return OdometrySource::kVelocities;
  if (input.odometry == "ticks") return OdometrySource::kTicks;
  throw std::invalid_argument("input.odometry: '" + input.odometry +
                              "' is none of auto, increments, velocities, ticks");
}

bool uses_velocity(const MotionAction& action, OdometrySource source) {
  if (source != OdometrySource::kVelocities || action.dt == 0.0) return false;
  if (!action.velocity) throw_absent(action, "velocities");
  return true;
}

Eigen::Vector3d movement_of(const MotionAction& action, OdometrySource source) {
  if (!uses_velocity(action, source)) return movement_along_arc(action.increment);
  const Eigen::Vector2d travel = action.dt * *action.velocity;
  return {travel[0], 0.0, travel[1]};
}

Eigen::Vector2d ticks_of(const MotionAction& action) {
  if (!action.ticks) throw_absent(action, "encoder ticks");
  return *action.ticks;
}

}  // namespace libslam
