#pragma once
// A vehicle that steers its front wheels, with speed and steering as calibration.
//
//   gamma' = scale_steering gamma + bias_steering
//   s_e'   = scale_speed (scale_left l + scale_right r) / 2
//   s      = s_e' / (1 - tan(gamma') H / L)
//   dphi   = s tan(gamma') / L
//
//   rear_axle   pose' = pose (+) arc(s, e, dphi)
//   front_axle  pose' = pose (+) R(gamma') arc(s / cos(gamma'), e, dphi)
//   seed        pose' = pose (+) (R(gamma') (s, e), dphi)            (S1.4), by Euler
//
// L = motion.wheelbase [m]. H = motion.encoder_offset [m], lateral place of the rear wheel that
// carries the encoder, left positive (Guivant & Nebot: v_c = v_e / (1 - tan(gamma) H / L)).
// gamma [rad] steering angle, left positive. s [m] travel of the centre of the rear axle. l, r [m]
// nominal travel of the encoder wheels. e [m] is noise alone: no steered vehicle goes sideways, and
// what the log says about it is ignored.
// The pose is that of the centre of the rear or of the front axle, x forward, y left. front_axle is
// Bailey's x' = v cos(phi + gamma), phi' = v sin(gamma) / L with v = s / (dt cos(gamma)),
// integrated exactly instead of by Euler. seed mixes both axles as the paper does: use it for truth
// and filter.
//
// Calibration: scale_left and scale_right, or scale_speed [1]; scale_steering [1]; bias_steering
// [rad]. With one encoder only the sum of scale_left and scale_right acts on the motion.
// Noise: along is added to s, and so turns the vehicle too; across to e, turn to dphi, steering to
// gamma'.
//
// Input, by `input.odometry`; l, r and gamma are recovered from the nominal motion of the log:
// - velocities: s = v dt, dphi = omega dt, of the centre of the rear axle;
// - increments (also auto): s and dphi of the arc through the logged increment. For a pose anywhere
//   on the centre line that is the travel of the rear axle. seed: s is the length of the increment;
// - ticks: l and r from the encoders of both wheels of an axle, dphi of the logged increment.
// gamma = atan(dphi L / s), in (-pi/2, pi/2) in reverse too, and with a single encoder
// l = r = s (1 - tan(gamma) H / L). s = 0 is no motion, whatever the log says about dphi.
//
// Limit: gamma and gamma' are clamped to 1.4 rad (80 deg), with H further so that the encoder wheel
// keeps at least a quarter of the speed. Beyond lies the pole of tan, where the jitter of a
// standing vehicle would be amplified without bound. A clamped angle has zero derivatives.

#include <libslam/motion/body_increment_model.hpp>
#include <libslam/motion/odometry_source.hpp>

namespace libslam {

class Ackermann final : public BodyIncrementModel {
 public:
  /// Throws std::invalid_argument on an unknown `motion.ackermann_form`, a wheelbase that is not
  /// positive, ticks together with an encoder offset, a calibration parameter that the vehicle does
  /// not have, or scale_speed enabled beside scale_left or scale_right (their product alone is
  /// observable).
  Ackermann(const MotionParameters& motion, const CalibrationParameters& calibration,
            OdometrySource source = OdometrySource::kIncrements);

  /// Largest steering angle that is not clamped [rad].
  double steering_limit() const { return steering_limit_; }

 private:
  enum class Form { kRearAxle, kFrontAxle, kSeed };
  /// What the encoders and the steering nominally said.
  struct Reading {
    double left = 0.0, right = 0.0;  ///< travel of the encoder wheels [m]
    double steering = 0.0;           ///< gamma [rad]
  };
  /// The motion after calibration.
  struct Drive {
    double travel = 0.0;    ///< s [m]
    double steering = 0.0;  ///< gamma' [rad]
    double slope = 0.0;     ///< tan(gamma')
    double lag = 1.0;       ///< speed of the encoder wheel per speed of the axle centre
    bool clamped = false;   ///< gamma' is at its limit
    Eigen::Vector3d movement =
        Eigen::Vector3d::Zero();  ///< (travel of the reference point, e, dphi)
  };
  /// Derivatives of the body increment.
  struct Rates {
    Eigen::Matrix3d by_movement = Eigen::Matrix3d::Identity();  ///< at a fixed steering angle
    Eigen::Vector3d by_travel = Eigen::Vector3d::Zero();        ///< by s
    Eigen::Vector3d by_steering = Eigen::Vector3d::Zero();      ///< by gamma', s_e' held
  };

  static Form form_of(const MotionParameters& motion);
  double clamp_steering(double steering) const;
  Eigen::Vector2d nominal_travel(const MotionAction& action) const;
  Reading read(const MotionAction& action) const;
  Drive drive(const CalibrationVector& calibration, const Reading& reading,
              const NoiseVector& noise) const;
  Eigen::Vector3d increment(const Drive& drive) const;
  Rates differentiate(const Drive& at, const Eigen::Vector3d& mean) const;

  BodyIncrement linearize_increment(const CalibrationVector& calibration,
                                    const MotionAction& action) const override;
  Eigen::Vector3d perturb_increment(const CalibrationVector& calibration,
                                    const MotionAction& action,
                                    const NoiseVector& noise) const override;

  Form form_;
  double wheelbase_;
  double offset_;  ///< H / L
  Eigen::Vector2d metres_per_tick_;
  double steering_limit_;
  OdometrySource source_;
};

}  // namespace libslam
