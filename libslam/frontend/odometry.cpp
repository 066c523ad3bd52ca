#include <cmath>
#include <cstring>

#include <Eigen/Dense>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>

#include <libslam/frontend/odometry.hpp>

namespace libslam {

namespace {

using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CActionRobotMovement3D;

// A 3-D movement is planar if it leaves the plane by less than this [m, rad].
constexpr double kPlanar = 1e-6;
// Faster robots are taken for garbage [m/s], [rad/s].
constexpr double kFastest = 100.0;

/// One movement as it stands in the log, with the presence flags as bytes: a corrupt log puts other
/// values than 0 and 1 into a bool, which may not be read as one.
struct Movement {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();
  unsigned char has_velocities = 0, has_ticks = 0;
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  Eigen::Vector2d ticks = Eigen::Vector2d::Zero();
};

unsigned char byte_of(const bool& flag) {
  static_assert(sizeof(bool) == 1);
  unsigned char byte = 0;
  std::memcpy(&byte, &flag, 1);
  return byte;
}

Movement read_planar(const CActionRobotMovement2D& action) {
  const auto [cov, mean] = action.poseChange->getCovarianceAndMean();
  Movement movement;
  movement.mean << mean.x(), mean.y(), mean.phi();
  movement.cov = cov.asEigen();
  movement.has_velocities = byte_of(action.hasVelocities);
  movement.has_ticks = byte_of(action.hasEncodersInfo);
  movement.velocity << action.velocityLocal.vx, action.velocityLocal.omega;
  movement.ticks << action.encoderLeftTicks, action.encoderRightTicks;
  return movement;
}

/// Velocities of 3-D movements are not read: they are no measure of the wheels.
Movement read_planar(const CActionRobotMovement3D& action, std::int64_t step) {
  const mrpt::poses::CPose3D& mean = action.poseChange.mean;
  const Eigen::Vector3d out_of_plane(mean.z(), mean.pitch(), mean.roll());
  if (!out_of_plane.allFinite() || out_of_plane.cwiseAbs().maxCoeff() > kPlanar) {
    throw UnusableOdometry(step, "the movement (CActionRobotMovement3D) is not planar: " +
                                     mean.asString() + "; a 2-D filter cannot use it");
  }
  Movement movement;
  movement.mean << mean.x(), mean.y(), mean.yaw();
  movement.cov = action.poseChange.cov.asEigen()({0, 1, 3}, {0, 1, 3});  // x, y, yaw
  return movement;
}

std::optional<Movement> best_movement(const LogStep& step) {
  CActionRobotMovement2D::Ptr first;
  for (const auto& entry : *step.action) {
    const auto movement = std::dynamic_pointer_cast<CActionRobotMovement2D>(entry.get_ptr());
    if (!movement) continue;
    if (!movement->poseChange) throw UnusableOdometry(step.index, "a movement without pose change");
    if (!first) first = movement;
  }
  if (first) {
    // MRPT's rule knows no best where every covariance is huge.
    const auto best = step.action->getBestMovementEstimation();
    return read_planar(best ? *best : *first);
  }
  const auto movement = step.action->getActionByClass<CActionRobotMovement3D>();
  if (!movement) return std::nullopt;
  return read_planar(*movement, step.index);
}

bool is_covariance(const Eigen::Matrix3d& cov) {
  if (!cov.allFinite()) return false;
  const double rounding = 1e-9 * cov.diagonal().cwiseAbs().sum();
  if (!((cov - cov.transpose()).cwiseAbs().maxCoeff() <= rounding)) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(cov, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()[0] >= -rounding;
}

/// All six velocities of a movement, if it has them; `action` may be null.
std::optional<HeldTwist> twist_of(const CActionRobotMovement3D* action) {
  constexpr std::size_t kCount = 6;
  if (action == nullptr || action->hasVelocities.size() != kCount ||
      static_cast<std::size_t>(action->velocities.size()) != kCount)
    return std::nullopt;
  for (const bool present : action->hasVelocities)
    if (!present) return std::nullopt;
  const auto& v = action->velocities;  // x, y, z, yaw, pitch, roll
  HeldTwist held;
  held.twist << v[0], v[1], v[2], v[5], v[4], v[3];
  return held;
}

/// The odometry of a step of body velocities.
std::optional<MotionAction> read_twist(const LogStep& step) {
  std::optional<HeldTwist> held = step.twist;
  if (!held) {
    if (!step.action) return std::nullopt;
    held = twist_of(step.action->getActionByClass<CActionRobotMovement3D>().get());
    if (!held)
      throw std::invalid_argument("input.odometry: step " + std::to_string(step.index) +
                                  " has no velocities in space (CActionRobotMovement3D)");
  }
  if (!held->twist.allFinite() || held->twist.cwiseAbs().maxCoeff() > kFastest)
    throw UnusableOdometry(step.index, "a velocity beyond 100 m/s or 100 rad/s");
  MotionAction action;
  action.time = step.time;
  action.dt = step.dt;
  action.twist = held->twist;
  action.hold = held->hold;
  return action;
}

void require_interval(const LogStep& step) {
  if (!(std::isfinite(step.time) && std::isfinite(step.dt) && step.dt >= 0.0))
    throw UnusableOdometry(step.index, "the interval of the odometry is not finite and positive");
}

/// Forward distance and turn of an increment.
Eigen::Vector2d forward_movement(const Eigen::Vector3d& increment) {
  const double heading = 0.5 * increment[2];
  return {increment[0] * std::cos(heading) + increment[1] * std::sin(heading), increment[2]};
}

/// Notes a flag that is neither set nor clear; true if the field is there.
bool is_present(unsigned char flag, std::int64_t step, FieldCheck& check) {
  if (flag > 1) {
    check.condemn(step, "its presence flag is " + std::to_string(flag) + ", neither 0 nor 1");
  }
  return flag == 1;
}

}  // namespace

OdometryReader::OdometryReader(const InputParameters& input)
    : choice_(choice_of(input)),
      strict_(input.policy == "strict"),
      velocities_(FieldCheck::Relation::kEqual, input.velocity_tolerance),
      ticks_(FieldCheck::Relation::kProportional, input.velocity_tolerance) {
  if (!strict_ && input.policy != "skip" && input.policy != "repair") {
    throw std::invalid_argument("input.policy: '" + input.policy +
                                "' is none of strict, skip, repair");
  }
}

OdometryReader::Choice OdometryReader::choice_of(const InputParameters& input) {
  if (input.odometry == "auto") return Choice::kAuto;
  if (input.odometry == "increments") return Choice::kIncrements;
  if (input.odometry == "velocities") return Choice::kVelocities;
  if (input.odometry == "ticks") return Choice::kTicks;
  if (input.odometry == "twist") return Choice::kTwist;
  throw std::invalid_argument("input.odometry: '" + input.odometry +
                              "' is none of auto, increments, velocities, ticks, twist");
}

std::optional<MotionAction> OdometryReader::read(const LogStep& step) {
  if (choice_ == Choice::kTwist) {
    require_interval(step);
    return read_twist(step);
  }
  if (!step.action) return std::nullopt;
  const std::optional<Movement> movement = best_movement(step);
  if (!movement) return std::nullopt;
  if (!movement->mean.allFinite()) {
    throw UnusableOdometry(step.index, "the pose increment is not finite");
  }
  require_interval(step);
  MotionAction action;
  action.time = step.time;
  action.dt = step.dt;
  action.increment = movement->mean;
  if (step.has_motion_covariance) action.cov_increment = movement->cov;
  if (is_present(movement->has_velocities, step.index, velocities_)) {
    action.velocity = movement->velocity;
  }
  if (is_present(movement->has_ticks, step.index, ticks_)) action.ticks = movement->ticks;
  check_covariance(step.index, action);
  check_fields(step.index, action);
  select(step.index, velocities_, Choice::kVelocities, "velocities", action.velocity, action.dt);
  select(step.index, ticks_, Choice::kTicks, "ticks", action.ticks, 1.0);
  return action;
}

void OdometryReader::check_covariance(std::int64_t step, MotionAction& action) {
  if (!action.cov_increment || is_covariance(*action.cov_increment)) return;
  if (strict_) {
    throw UnusableOdometry(step,
                           "the covariance of the pose increment is not finite, symmetric "
                           "and positive semi-definite");
  }
  action.cov_increment.reset();
  ++dropped_covariances_;
}

void OdometryReader::check_fields(std::int64_t step, MotionAction& action) {
  const Eigen::Vector2d moved = forward_movement(action.increment);
  if (action.velocity) {
    if (!action.velocity->allFinite() || action.velocity->cwiseAbs().maxCoeff() > kFastest) {
      velocities_.condemn(step, "a velocity beyond 100 m/s or 100 rad/s");
    } else if (action.dt > 0.0) {
      velocities_.observe(step, action.dt * *action.velocity, moved);
    } else {
      velocities_.note_present();
    }
  }
  if (action.ticks) ticks_.observe(step, *action.ticks, moved);
}

template <class Field>
void OdometryReader::select(std::int64_t step, const FieldCheck& check, Choice own,
                            const char* name, std::optional<Field>& field, double dt) const {
  if (choice_ == own) {
    const bool insane = check.verdict() == FieldVerdict::kInsane;
    if ((field || dt == 0.0) && !insane) return;  // without an interval the increment serves
    throw std::invalid_argument(
        std::string("input.odometry: the log's ") + name + " cannot be used: " +
        (insane ? check.reason() : "step " + std::to_string(step) + " has none"));
  }
  if (choice_ != Choice::kAuto || check.verdict() != FieldVerdict::kSane) field.reset();
}

std::vector<std::string> OdometryReader::warnings() const {
  std::vector<std::string> lines;
  const auto report = [&](const FieldCheck& check, const std::string& name, Choice own) {
    if (check.verdict() == FieldVerdict::kInsane) {
      lines.push_back("odometry: " + name + " of the log are not used: " + check.reason());
    } else if (check.verdict() == FieldVerdict::kUndecided && choice_ == own) {
      lines.push_back("odometry: " + name +
                      " of the log are used unchecked: too few moving readings with times");
    }
  };
  report(velocities_, "velocities", Choice::kVelocities);
  report(ticks_, "ticks", Choice::kTicks);
  if (dropped_covariances_ > 0) {
    lines.push_back("odometry: " + std::to_string(dropped_covariances_) +
                    " covariances of pose increments are no covariances and were dropped");
  }
  return lines;
}

}  // namespace libslam
