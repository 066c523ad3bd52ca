#include <stdexcept>

#include <libslam/motion/arc.hpp>
#include <libslam/motion/odometry_increment.hpp>

namespace libslam {

OdometryIncrement::OdometryIncrement(const MotionParameters& motion,
                                     const CalibrationParameters& calibration,
                                     OdometrySource source)
    : BodyIncrementModel(motion.noise,
                         CalibrationLayout(calibration, {kScaleSpeed, kScaleTurn, kBiasTurn},
                                           "odometry_increment")),
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

Eigen::Vector3d OdometryIncrement::calibrated(const CalibrationVector& c,
                                              const Eigen::Vector3d& movement) {
  return {c[kScaleSpeed] * movement[kAlong], movement[kAcross],
          c[kScaleTurn] * movement[kTurn] + c[kBiasTurn] * movement[kAlong]};
}

void OdometryIncrement::differentiate(const Eigen::Vector3d& movement,
                                      const Eigen::Matrix3d& jacobian, BodyIncrement& body) {
  body.wrt_calibration.col(kScaleSpeed) = jacobian.col(kAlong) * movement[kAlong];
  body.wrt_calibration.col(kScaleTurn) = jacobian.col(kTurn) * movement[kTurn];
  body.wrt_calibration.col(kBiasTurn) = jacobian.col(kTurn) * movement[kAlong];
}

/// Without calibration an increment is taken as it is, to the last bit.
bool OdometryIncrement::is_neutral(const CalibrationVector& c) const {
  return layout().specs().empty() && c[kScaleSpeed] == 1.0 && c[kScaleTurn] == 1.0 &&
         c[kBiasTurn] == 0.0;
}

BodyIncrement OdometryIncrement::linearize_increment(const CalibrationVector& calibration,
                                                     const MotionAction& action) const {
  const Eigen::Vector3d nominal = increment(action);
  BodyIncrement body;
  body.variance = noise().variance(action.dt, movement_along_arc(nominal)[kAlong], nominal[kTurn]);
  if (form_ == Form::kComposition) {
    body.mean = nominal;
    body.wrt_noise.leftCols<3>().setIdentity();
    if (is_neutral(calibration)) return body;
    const Eigen::Vector3d movement = movement_along_arc(nominal);
    const ArcIncrement arc = follow_arc(calibrated(calibration, movement));
    body.mean = arc.increment;
    differentiate(movement, arc.jacobian, body);
  } else {
    const Eigen::Vector3d movement = forward_movement(nominal);
    const ArcIncrement arc = follow_chord(calibrated(calibration, movement));
    body.mean = arc.increment;
    body.wrt_noise.leftCols<3>() = arc.jacobian;
    differentiate(movement, arc.jacobian, body);
  }
  return body;
}

Eigen::Vector3d OdometryIncrement::perturb_increment(const CalibrationVector& calibration,
                                                     const MotionAction& action,
                                                     const NoiseVector& noise) const {
  const Eigen::Vector3d nominal = increment(action);
  if (form_ == Form::kArc)
    return follow_chord(calibrated(calibration, forward_movement(nominal)) + noise.head<3>())
        .increment;
  if (is_neutral(calibration)) return nominal + noise.head<3>();
  return follow_arc(calibrated(calibration, movement_along_arc(nominal))).increment +
         noise.head<3>();
}

}  // namespace libslam
