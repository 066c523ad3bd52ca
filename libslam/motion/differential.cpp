#include <stdexcept>
#include <string>

#include <libslam/motion/arc.hpp>
#include <libslam/motion/differential.hpp>

namespace libslam {

Differential::Differential(const MotionParameters& motion, const CalibrationParameters& calibration,
                           OdometrySource source)
    : BodyIncrementModel(
          motion.noise,
          CalibrationLayout(calibration, {kScaleLeft, kScaleRight, kTrackWidth}, "differential")),
      track_width_(motion.track_width),
      metres_per_tick_(motion.metres_per_tick_left, motion.metres_per_tick_right),
      source_(source) {
  if (!(track_width_ > 0.0)) {
    throw std::invalid_argument("motion.track_width must be positive, is " +
                                std::to_string(track_width_));
  }
  if (source == OdometrySource::kTicks && !(metres_per_tick_.minCoeff() > 0.0)) {
    throw std::invalid_argument("motion.metres_per_tick_left and _right must be positive, are " +
                                std::to_string(metres_per_tick_[0]) + " and " +
                                std::to_string(metres_per_tick_[1]));
  }
}

Differential::WheelTravel Differential::travel(const MotionAction& action) const {
  if (source_ == OdometrySource::kTicks) {
    const Eigen::Vector2d wheels = metres_per_tick_.cwiseProduct(ticks_of(action));
    return {wheels[0], wheels[1], 0.0};
  }
  const Eigen::Vector3d nominal = movement_of(action, source_);
  const double difference = 0.5 * track_width_ * nominal[kTurn];
  return {nominal[kAlong] - difference, nominal[kAlong] + difference, nominal[kAcross]};
}

Eigen::Vector3d Differential::movement(const CalibrationVector& calibration,
                                       const WheelTravel& travel) const {
  const double left = calibration[kScaleLeft] * travel.left;
  const double right = calibration[kScaleRight] * travel.right;
  return {0.5 * (left + right), travel.across,
          (right - left) / (track_width_ * calibration[kTrackWidth])};
}

BodyIncrement Differential::linearize_increment(const CalibrationVector& calibration,
                                                const MotionAction& action) const {
  const WheelTravel wheels = travel(action);
  const Eigen::Vector3d moved = movement(calibration, wheels);
  const ArcIncrement arc = follow_arc(moved);
  const double per_track = 1.0 / (track_width_ * calibration[kTrackWidth]);

  BodyIncrement body;
  body.mean = arc.increment;
  body.wrt_noise.leftCols<3>() = arc.jacobian;
  body.variance = noise().variance(action.dt, moved[kAlong], moved[kTurn]);
  body.wrt_calibration.col(kScaleLeft) =
      arc.jacobian * Eigen::Vector3d(0.5, 0.0, -per_track) * wheels.left;
  body.wrt_calibration.col(kScaleRight) =
      arc.jacobian * Eigen::Vector3d(0.5, 0.0, per_track) * wheels.right;
  body.wrt_calibration.col(kTrackWidth) =
      arc.jacobian.col(kTurn) * (-moved[kTurn] / calibration[kTrackWidth]);
  return body;
}

Eigen::Vector3d Differential::perturb_increment(const CalibrationVector& calibration,
                                                const MotionAction& action,
                                                const NoiseVector& noise) const {
  return follow_arc(movement(calibration, travel(action)) + noise.head<3>()).increment;
}

}  // namespace libslam
