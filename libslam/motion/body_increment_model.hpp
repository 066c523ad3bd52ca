#pragma once
// What all planar motion models share: an increment in the body frame, composed with the pose.
//
//   x'  = x (+) f(c, u, w)
//   x (+) d = (x + dx cos phi - dy sin phi,  y + dx sin phi + dy cos phi,  phi + dphi)
//   F_x = [1 0 -dx s - dy c;  0 1 dx c - dy s;  0 0 1]        c = cos phi, s = sin phi
//   F_c = R(phi) df/dc,   Q = R(phi) C R(phi)^T
//
// with c the calibration, u the odometry, w the noise inputs (odometry_noise.hpp), and
// C = df/dw diag(var w) df/dw^T, or the log's own covariance of the increment where it has one and
// `motion.noise.from_log` is set. R(phi) turns x and y and leaves the heading alone.

#include <utility>

#include <libslam/motion/calibration_layout.hpp>
#include <libslam/motion/motion_model.hpp>
#include <libslam/motion/odometry_noise.hpp>

namespace libslam {

/// f(c, u, 0), its derivatives, and the variances of the noise inputs.
struct BodyIncrement {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< dx [m], dy [m], dphi [rad]
  Eigen::Matrix<double, 3, kCalibrationCount> wrt_calibration =
      Eigen::Matrix<double, 3, kCalibrationCount>::Zero();
  Eigen::Matrix<double, 3, kNoiseInputs> wrt_noise = Eigen::Matrix<double, 3, kNoiseInputs>::Zero();
  NoiseVector variance = NoiseVector::Zero();
};

/// x (+) increment, heading wrapped to (-pi, pi].
Eigen::Vector3d compose_increment(const Eigen::Vector3d& pose, const Eigen::Vector3d& increment);

/// A motion model that is defined by its body increment.
class BodyIncrementModel : public MotionModel {
 public:
  const std::vector<CalibrationSpec>& calibration() const final { return layout_.specs(); }

  void linearize(const GaussianState& state, BlockId pose, const CalibrationBlocks& blocks,
                 const MotionAction& action, MotionStep& step) const final;

  /// `calibration`: values in the order of `calibration()`. Noise enters where it does in the
  /// linearization and passes through the full motion.
  /// Throws std::invalid_argument on another number of values.
  BlockVector sample(const BlockVector& pose, const Eigen::VectorXd& calibration,
                     const MotionAction& action, std::mt19937_64& random) const final;

 protected:
  BodyIncrementModel(const OdometryNoiseParameters& noise, CalibrationLayout layout)
      : layout_(std::move(layout)), noise_(noise) {}

  const CalibrationLayout& layout() const { return layout_; }
  const OdometryNoise& noise() const { return noise_; }

 private:
  /// f(c, u, 0) with derivatives.
  virtual BodyIncrement linearize_increment(const CalibrationVector& calibration,
                                            const MotionAction& action) const = 0;
  /// f(c, u, w).
  virtual Eigen::Vector3d perturb_increment(const CalibrationVector& calibration,
                                            const MotionAction& action,
                                            const NoiseVector& noise) const = 0;

  bool uses_log_covariance(const MotionAction& action) const {
    return noise_.prefers_log() && action.cov_increment.has_value();
  }
  void require_values(Eigen::Index count) const;

  CalibrationLayout layout_;
  OdometryNoise noise_;
};

}  // namespace libslam
