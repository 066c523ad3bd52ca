#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <libslam/motion/ackermann.hpp>
#include <libslam/motion/arc.hpp>

namespace libslam {

namespace {

constexpr double kMaxSteering = 1.4;
constexpr double kLeastEncoderSpeed = 0.25;

}  // namespace

Ackermann::Ackermann(const MotionParameters& motion, const CalibrationParameters& calibration,
                     OdometrySource source)
    : BodyIncrementModel(motion.noise, CalibrationLayout(calibration,
                                                         {kScaleLeft, kScaleRight, kScaleSpeed,
                                                          kScaleSteering, kBiasSteering},
                                                         "ackermann")),
      form_(form_of(motion)),
      wheelbase_(motion.wheelbase),
      offset_(motion.encoder_offset / motion.wheelbase),
      metres_per_tick_(motion.metres_per_tick_left, motion.metres_per_tick_right),
      steering_limit_(kMaxSteering),
      source_(source) {
  if (!(wheelbase_ > 0.0)) {
    throw std::invalid_argument("motion.wheelbase must be positive, is " +
                                std::to_string(wheelbase_));
  }
  if (source == OdometrySource::kTicks && offset_ != 0.0) {
    throw std::invalid_argument(
        "motion.encoder_offset must be 0 with ticks: two encoders give the speed of the axle "
        "centre");
  }
  if (layout().enabled(kScaleSpeed) &&
      (layout().enabled(kScaleLeft) || layout().enabled(kScaleRight))) {
    throw std::invalid_argument(
        "calibration.scale_speed and calibration.scale_left or scale_right: only their product is "
        "observable, enable one of them");
  }
  if (offset_ != 0.0) {
    steering_limit_ =
        std::min(kMaxSteering, std::atan((1.0 - kLeastEncoderSpeed) / std::abs(offset_)));
  }
}

Ackermann::Form Ackermann::form_of(const MotionParameters& motion) {
  if (motion.ackermann_form == "rear_axle") return Form::kRearAxle;
  if (motion.ackermann_form == "front_axle") return Form::kFrontAxle;
  if (motion.ackermann_form == "seed") return Form::kSeed;
  throw std::invalid_argument("motion.ackermann_form: '" + motion.ackermann_form +
                              "' is none of rear_axle, front_axle, seed");
}

double Ackermann::clamp_steering(double steering) const {
  return std::clamp(steering, -steering_limit_, steering_limit_);
}

Eigen::Vector2d Ackermann::nominal_travel(const MotionAction& action) const {
  if (form_ == Form::kSeed && !uses_velocity(action, source_)) {
    return {std::copysign(action.increment.head<2>().norm(), action.increment.x()),
            action.increment[kTurn]};
  }
  const Eigen::Vector3d movement = movement_of(action, source_);
  return {movement[kAlong], movement[kTurn]};
}

Ackermann::Reading Ackermann::read(const MotionAction& action) const {
  Reading reading;
  Eigen::Vector2d nominal = nominal_travel(action);
  if (source_ == OdometrySource::kTicks) {
    const Eigen::Vector2d wheels = metres_per_tick_.cwiseProduct(ticks_of(action));
    reading.left = wheels[0];
    reading.right = wheels[1];
    nominal[0] = wheels.mean();
  }
  if (nominal[0] != 0.0) {
    reading.steering = clamp_steering(std::atan(nominal[1] * wheelbase_ / nominal[0]));
  }
  if (source_ != OdometrySource::kTicks) {
    reading.left = nominal[0] * (1.0 - offset_ * std::tan(reading.steering));
    reading.right = reading.left;
  }
  return reading;
}

Ackermann::Drive Ackermann::drive(const CalibrationVector& calibration, const Reading& reading,
                                  const NoiseVector& noise) const {
  Drive drive;
  const double steering = calibration[kScaleSteering] * reading.steering +
                          calibration[kBiasSteering] + noise[kSteering];
  drive.steering = clamp_steering(steering);
  drive.clamped = drive.steering != steering;
  drive.slope = std::tan(drive.steering);
  drive.lag = 1.0 - offset_ * drive.slope;
  const double encoder =
      0.5 * calibration[kScaleSpeed] *
      (calibration[kScaleLeft] * reading.left + calibration[kScaleRight] * reading.right);
  drive.travel = encoder / drive.lag + noise[kAlong];
  const double reference =
      form_ == Form::kFrontAxle ? drive.travel / std::cos(drive.steering) : drive.travel;
  drive.movement = {reference, noise[kAcross],
                    drive.travel * drive.slope / wheelbase_ + noise[kTurn]};
  return drive;
}

Eigen::Vector3d Ackermann::increment(const Drive& drive) const {
  switch (form_) {
    case Form::kRearAxle:
      return follow_arc(drive.movement).increment;
    case Form::kFrontAxle:
      return rotate_planar(drive.steering) * follow_arc(drive.movement).increment;
    case Form::kSeed:
      break;
  }
  return rotate_planar(drive.steering) * drive.movement;
}

Ackermann::Rates Ackermann::differentiate(const Drive& at, const Eigen::Vector3d& mean) const {
  Rates rates;
  if (form_ != Form::kSeed) rates.by_movement = follow_arc(at.movement).jacobian;
  if (form_ != Form::kRearAxle) rates.by_movement = rotate_planar(at.steering) * rates.by_movement;

  // The travel of the reference point is `stretch` times that of the rear axle.
  const bool front = form_ == Form::kFrontAxle;
  const double stretch = front ? 1.0 / std::cos(at.steering) : 1.0;
  const double stretch_rate = front ? stretch * at.slope : 0.0;
  const double slope_rate = 1.0 + at.slope * at.slope;
  rates.by_travel = rates.by_movement * Eigen::Vector3d(stretch, 0.0, at.slope / wheelbase_);
  if (at.clamped) return rates;
  const double travel_rate = at.travel * offset_ * slope_rate / at.lag;
  rates.by_steering =
      rates.by_movement * Eigen::Vector3d(stretch_rate, 0.0, slope_rate / wheelbase_) * at.travel +
      rates.by_travel * travel_rate;
  if (form_ != Form::kRearAxle) rates.by_steering += Eigen::Vector3d(-mean.y(), mean.x(), 0.0);
  return rates;
}

BodyIncrement Ackermann::linearize_increment(const CalibrationVector& calibration,
                                             const MotionAction& action) const {
  const Reading reading = read(action);
  const Drive at = drive(calibration, reading, NoiseVector::Zero());
  BodyIncrement body;
  body.mean = increment(at);
  body.variance = noise().variance(action.dt, at.travel, at.movement[kTurn]);

  const Rates rates = differentiate(at, body.mean);
  const double scale_speed = calibration[kScaleSpeed];
  const Eigen::Vector3d by_encoders = rates.by_travel * (0.5 / at.lag);
  body.wrt_calibration.col(kScaleLeft) = by_encoders * scale_speed * reading.left;
  body.wrt_calibration.col(kScaleRight) = by_encoders * scale_speed * reading.right;
  body.wrt_calibration.col(kScaleSpeed) = by_encoders * (calibration[kScaleLeft] * reading.left +
                                                         calibration[kScaleRight] * reading.right);
  body.wrt_calibration.col(kScaleSteering) = rates.by_steering * reading.steering;
  body.wrt_calibration.col(kBiasSteering) = rates.by_steering;

  body.wrt_noise.col(kAlong) = rates.by_travel;
  body.wrt_noise.col(kAcross) = rates.by_movement.col(kAcross);
  body.wrt_noise.col(kTurn) = rates.by_movement.col(kTurn);
  body.wrt_noise.col(kSteering) = rates.by_steering;
  return body;
}

Eigen::Vector3d Ackermann::perturb_increment(const CalibrationVector& calibration,
                                             const MotionAction& action,
                                             const NoiseVector& noise) const {
  return increment(drive(calibration, read(action), noise));
}

}  // namespace libslam
