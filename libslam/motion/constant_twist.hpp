#pragma once
// Motion in space without any odometry: the body keeps its velocity (twist_model.hpp).
//
//   v, w: six states that walk at random, velocity_x, _y, _z [m/s] and rate_x, _y, _z [rad/s]
//
// The walk reaches the pose within a step with the variance q^2 dt^3 / 3 and, later, through the
// velocity. Input: the time alone. Source: the constant-velocity model of Davison et al., MonoSLAM,
// IEEE TPAMI 29(6), 2007, section 3.4, here with the velocity in the body frame.

#include <libslam/config/parameters.hpp>
#include <libslam/motion/twist_model.hpp>

namespace libslam {

class ConstantTwist final : public TwistModel {
 public:
  explicit ConstantTwist(const ConstantTwistParameters& parameters);

 private:
  Twist reference(const MotionAction& action) const override;
  Twist derivative(const MotionAction& action, std::size_t parameter) const override;
  Twist variance(const MotionAction& action) const override;

  Twist walk2_;
};

}  // namespace libslam
