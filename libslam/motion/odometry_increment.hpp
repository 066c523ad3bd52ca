#pragma once
// Motion by pose increments, without calibration.
//
// - composition (default): x' = x (+) (dx, dy, dphi), the transition of MRPT's
//   CRangeBearingKFSLAM2D, with noise on (dx, dy, dphi).
// - arc: the midpoint rule (S3.1), (S3.2)
//     x' = x + dD cos(phi + dphi/2),  y' = y + dD sin(phi + dphi/2),  phi' = phi + dphi
//   with noise on dD, across the mid heading, and on dphi. dD is the displacement along the mid
//   heading; sideways motion of the log is ignored.
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
  /// parameter, or ticks as the source.
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
  /// (dD, across, dphi) of the arc form: no sideways motion.
  static Eigen::Vector3d forward_movement(const Eigen::Vector3d& increment);

  Form form_;
  OdometrySource source_;
};

}  // namespace libslam
