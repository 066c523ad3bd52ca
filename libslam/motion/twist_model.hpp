#pragma once
// What all motion models in space share: a body velocity, held over dt, composed with the pose.
//
//   u = (v dt, w dt) + n,   R' = R Exp(w dt),   p' = p + R V(w dt) v dt          (exact, SE(3))
//   F_x = [I  -[p' - p]; 0  I],   F_u = [R V  R d(V v dt)/d(w dt); 0  R V]
//
// in the additive chart of the pose block: (dp, dtheta), both in the world frame (state/block.hpp).
// v and w may depend linearly on calibration values. V: state/so3.hpp. Source: Barfoot, State
// Estimation for Robotics, 2017, sections 7.1 and 7.2; derivatives for the world-frame error by us.

#include <vector>

#include <Eigen/Core>

#include <libslam/motion/motion_model.hpp>

namespace libslam {

/// vx, vy, vz [m/s], wx, wy, wz [rad/s] in the body frame (x forward, y left, z up), or the same
/// times seconds.
using Twist = Eigen::Matrix<double, 6, 1>;

class TwistModel : public MotionModel {
 public:
  BlockSpec pose_spec() const final { return {"pose", Chart::kSE3, 6, WorldRole::kPose}; }
  const std::vector<CalibrationSpec>& calibration() const final { return specs_; }

  void linearize(const GaussianState& state, BlockId pose, const CalibrationBlocks& blocks,
                 const MotionAction& action, MotionStep& step) const final;
  /// `calibration`: values in the order of `calibration()`. Throws std::invalid_argument on another
  /// number of values.
  BlockVector sample(const BlockVector& pose, const Eigen::VectorXd& calibration,
                     const MotionAction& action, std::mt19937_64& random) const final;

 protected:
  explicit TwistModel(std::vector<CalibrationSpec> specs) : specs_(std::move(specs)) {}

 private:
  /// The velocity over the interval of `action` where every calibration value is zero. Throws
  /// std::invalid_argument if the action lacks it.
  virtual Twist reference(const MotionAction& action) const = 0;
  /// d twist / d value of the calibration parameter with this position.
  virtual Twist derivative(const MotionAction& action, std::size_t parameter) const = 0;
  /// Variances of twist times dt.
  virtual Twist variance(const MotionAction& action) const = 0;

  Twist displacement(const MotionAction& action, const VectorRef& values) const;
  void require_values(Eigen::Index count) const;

  std::vector<CalibrationSpec> specs_;
};

}  // namespace libslam
