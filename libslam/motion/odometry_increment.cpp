#include <stdexcept>

#include <libslam/motion/arc.hpp>
#include <libslam/motion/odometry_increment.hpp>

namespace libslam {

OdometryIncrement::OdometryIncrement(const MotionParameters& motion,
                                     const CalibrationParameters& calibration,
                                     OdometrySource source)
    : BodyIncrementModel(motion.noise, CalibrationLayout(calibration, {}, "odometry_increment")),
      form_(form_of(motion)),
      source_(source) {
  if (source == OdometrySource::kTicks) {
    throw std::invalid_argument(
        "motion.model odometry_increment cannot use ticks (input.odometry); use differential");
  }
}

OdometryIncrement::Form OdometryIncrement::form_of(const MotionParameters& motion) {
  if (motion.increment_form == "composition") return Form::kComposition;
  if (motion.increment_form == "arc") return Form::kArc;
  throw std::invalid_argument("motion.increment_form: '" + motion.increment_form +
                              "' is none of composition, arc");
}

Eigen::Vector3d OdometryIncrement::increment(const MotionAction& action) const {
  if (!uses_velocity(action, source_)) return action.increment;
  return follow_arc(movement_of(action, source_)).increment;
}

Eigen::Vector3d OdometryIncrement::forward_movement(const Eigen::Vector3d& increment) {
  Eigen::Vector3d movement = movement_along_chord(increment);
  movement[kAcross] = 0.0;
  return movement;
}

BodyIncrement OdometryIncrement::linearize_increment(const CalibrationVector&,
                                                     const MotionAction& action) const {
  const Eigen::Vector3d nominal = increment(action);
  BodyIncrement body;
  body.variance = noise().variance(action.dt, movement_along_arc(nominal)[kAlong], nominal[kTurn]);
  if (form_ == Form::kComposition) {
    body.mean = nominal;
    body.wrt_noise.leftCols<3>().setIdentity();
  } else {
    const ArcIncrement arc = follow_chord(forward_movement(nominal));
    body.mean = arc.increment;
    body.wrt_noise.leftCols<3>() = arc.jacobian;
  }
  return body;
}

Eigen::Vector3d OdometryIncrement::perturb_increment(const CalibrationVector&,
                                                     const MotionAction& action,
                                                     const NoiseVector& noise) const {
  const Eigen::Vector3d nominal = increment(action);
  if (form_ == Form::kComposition) return nominal + noise.head<3>();
  return follow_chord(forward_movement(nominal) + noise.head<3>()).increment;
}

}  // namespace libslam
