#pragma once
// Motion by pose increments.
//
// - composition (default): x' = x (+) (dx, dy, dphi), the transition of MRPT's
//   CRangeBearingKFSLAM2D, with noise on (dx, dy, dphi).
// - arc: the midpoint rule (S3.1), (S3.2)
//     x' = x + dD cos(phi + dphi/2),  y' = y + dD sin(phi + dphi/2),  phi' = phi + dphi
//   with noise on dD, across the mid heading, and on dphi. dD is the displacement along the mid
//   heading; sideways motion of the log is ignored.
//
// Calibration, optional: along the arc of the increment (arc.hpp) the odometry drove ds, slid e and
// turned by dphi; the robot did
//
//   (scale_speed ds,  e,  scale_turn dphi + bias_turn ds)
//
// Wheels of different size make bias_turn, a wrong track width scale_turn, a wrong mean size
// scale_speed (Borenstein & Feng, IEEE Trans. Robotics and Automation 12(6), 1996), here for
// increments of which the wheels and the track are not known.
//
// Input: pose increments (`input.odometry` auto or increments), or velocities as an exact arc.
// Ticks are refused: without a track width they make no increment.
// Units m, rad, s; frame of the robot at the start of the step (x forward, y left).

#include <libslam/motion/body_increment_model.hpp>
#include <libslam/motion/odometry_source.hpp>

namespace libslam {

class OdometryIncrement final : public BodyIncrementModel {
 public:
  /// Throws std::invalid_argument on an unknown `motion.increment_form`, an enabled calibration
  /// parameter that is not one of its own, or ticks as the source.
  OdometryIncrement(const MotionParameters& motion, const CalibrationParameters& calibration,
                    OdometrySource source = OdometrySource::kIncrements);

 private:
  enum class Form { kComposition, kArc };
  static Form form_of(const MotionParameters& motion);

  BodyIncrement linearize_increment(const CalibrationVector& calibration,
                                    const MotionAction& action) const override;
  Eigen::Vector3d perturb_increment(const CalibrationVector& calibration,
                                    const MotionAction& action,
                                    const NoiseVector& noise) const override;
  Eigen::Vector3d increment(const MotionAction& action) const;
  /// What the robot did where the odometry says `movement` (ds, e, dphi).
  static Eigen::Vector3d calibrated(const CalibrationVector& c, const Eigen::Vector3d& movement);
  /// Columns of the calibration for a movement whose increment has the derivative `jacobian`.
  static void differentiate(const Eigen::Vector3d& movement, const Eigen::Matrix3d& jacobian,
                            BodyIncrement& body);
  bool is_neutral(const CalibrationVector& calibration) const;
  /// (dD, across, dphi) of the arc form: no sideways motion.
  static Eigen::Vector3d forward_movement(const Eigen::Vector3d& increment);

  Form form_;
  OdometrySource source_;
};

}  // namespace libslam
