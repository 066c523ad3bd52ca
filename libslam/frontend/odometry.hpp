#pragma once
// From the actions of a log to odometry steps.
//
// Accepted: CActionRobotMovement2D (the best of the collection by MRPT's own rule), or a planar
// CActionRobotMovement3D. Pose increments always drive; velocities and encoder ticks are passed on
// as `input.odometry` says, and never against the verdict of odometry_check.hpp:
//
// | input.odometry | velocities                       | ticks                            |
// |----------------|----------------------------------|----------------------------------|
// | auto           | once found sane                  | once found sane                  |
// | increments     | no                               | no                               |
// | velocities     | unless insane (then it throws)   | no                               |
// | ticks          | no                               | unless insane (then it throws)   |
//
// With `input.odometry` twist the velocities of the body drive a robot in space: those of a sensor
// (LogStep::twist), else all six of a CActionRobotMovement3D. Its pose increments are not looked
// at.

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <libslam/config/parameters.hpp>
#include <libslam/data/log_step.hpp>
#include <libslam/data/motion_action.hpp>
#include <libslam/frontend/odometry_check.hpp>

namespace libslam {

/// The odometry of one step of the log cannot be used; the steps around it may be fine.
class UnusableOdometry : public std::runtime_error {
 public:
  UnusableOdometry(std::int64_t step, const std::string& why)
      : std::runtime_error("step " + std::to_string(step) + ": " + why), step_(step) {}
  std::int64_t step() const { return step_; }

 private:
  std::int64_t step_;
};

class OdometryReader {
 public:
  /// Throws std::invalid_argument on an unknown `input.odometry` or `input.policy`.
  explicit OdometryReader(const InputParameters& input);

  /// The odometry of `step`, or nothing where the step has no action or its action no movement.
  ///
  /// Throws UnusableOdometry on a non-finite increment or interval, a movement that is not planar,
  /// or a corrupt entry; with `input.policy` strict also on a covariance that is none (otherwise
  /// the covariance is dropped and counted). Throws std::invalid_argument naming the step as soon
  /// as the field that `input.odometry` asks for is absent or insane.
  std::optional<MotionAction> read(const LogStep& step);

  const FieldCheck& velocities() const { return velocities_; }
  const FieldCheck& ticks() const { return ticks_; }
  /// One line per finding about the log so far, for the user; empty if all is well.
  std::vector<std::string> warnings() const;

 private:
  enum class Choice { kAuto, kIncrements, kVelocities, kTicks, kTwist };
  static Choice choice_of(const InputParameters& input);

  void check_covariance(std::int64_t step, MotionAction& action);
  void check_fields(std::int64_t step, MotionAction& action);
  /// Applies the table above to one optional field; a field that needs an interval may be absent
  /// where `dt` is 0.
  template <class Field>
  void select(std::int64_t step, const FieldCheck& check, Choice own, const char* name,
              std::optional<Field>& field, double dt) const;

  Choice choice_;
  bool strict_;
  FieldCheck velocities_;
  FieldCheck ticks_;
  int dropped_covariances_ = 0;
};

}  // namespace libslam
