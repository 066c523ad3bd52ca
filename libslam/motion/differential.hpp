#pragma once
// Two driven wheels on one axle, with wheel radii and track width as calibration.
//
//   dl' = scale_left dl,   dr' = scale_right dr
//   ds  = (dl' + dr') / 2,   dphi = (dr' - dl') / (b track_width)
//   pose' = pose (+) arc(ds, e, dphi)                     exact arc, arc.hpp
//
// with dl, dr the nominal travel of the wheels [m], b = motion.track_width [m], and `track_width` a
// factor on it. Pose: centre of the axle, x forward, y left.
// Calibration: scale_left, scale_right, track_width [1], each on its own switch. On a straight line
// the column of track_width is zero; at standstill all are.
// Noise: along, across and turn, added to (ds, e, dphi).
//
// Input, by `input.odometry`:
// - ticks: dl = metres_per_tick_left * left, dr likewise, e = 0;
// - velocities: dl = (v - omega b / 2) dt, dr = (v + omega b / 2) dt, e = 0;
// - increments (also auto): the arc through the logged increment gives ds and dphi, and through b
//   the travel of the wheels. b need not be the real track: with a virtual track the scales are
//   those of virtual wheels. e, the sideways part that no such drive can make (slip, or a pose off
//   the axle), is kept unscaled, so that with all factors 1 the model is the plain composition.

#include <libslam/motion/body_increment_model.hpp>
#include <libslam/motion/odometry_source.hpp>

namespace libslam {

class Differential final : public BodyIncrementModel {
 public:
  /// Throws std::invalid_argument if a dimension is not positive, or if a calibration parameter is
  /// enabled that the drive does not have.
  Differential(const MotionParameters& motion, const CalibrationParameters& calibration,
               OdometrySource source = OdometrySource::kIncrements);

 private:
  /// Nominal wheel travel and the sideways remainder, all [m].
  struct WheelTravel {
    double left = 0.0, right = 0.0, across = 0.0;
  };

  WheelTravel travel(const MotionAction& action) const;
  /// Calibrated (ds, e, dphi).
  Eigen::Vector3d movement(const CalibrationVector& calibration, const WheelTravel& travel) const;

  BodyIncrement linearize_increment(const CalibrationVector& calibration,
                                    const MotionAction& action) const override;
  Eigen::Vector3d perturb_increment(const CalibrationVector& calibration,
                                    const MotionAction& action,
                                    const NoiseVector& noise) const override;

  double track_width_;
  Eigen::Vector2d metres_per_tick_;
  OdometrySource source_;
};

}  // namespace libslam
