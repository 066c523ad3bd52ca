#include <array>

#include <libslam/motion/constant_twist.hpp>

namespace libslam {

namespace {

std::vector<CalibrationSpec> velocity_states(const ConstantTwistParameters& p) {
  constexpr std::array<const char*, 6> kNames = {"velocity_x", "velocity_y", "velocity_z",
                                                 "rate_x",     "rate_y",     "rate_z"};
  std::vector<CalibrationSpec> specs;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const bool linear = i < 3;
    specs.push_back({kNames[i], 0.0, linear ? p.sigma_speed : p.sigma_rate,
                     linear ? p.speed_walk_per_sqrt_s : p.rate_walk_per_sqrt_s, true});
  }
  return specs;
}

}  // namespace

ConstantTwist::ConstantTwist(const ConstantTwistParameters& parameters)
    : TwistModel(velocity_states(parameters)) {
  Twist walk;
  walk << Eigen::Vector3d::Constant(parameters.speed_walk_per_sqrt_s),
      Eigen::Vector3d::Constant(parameters.rate_walk_per_sqrt_s);
  walk2_ = walk.cwiseAbs2();
}

Twist ConstantTwist::reference(const MotionAction&) const {
  return Twist::Zero();
}

Twist ConstantTwist::derivative(const MotionAction&, std::size_t parameter) const {
  return Twist::Unit(static_cast<Eigen::Index>(parameter));
}

Twist ConstantTwist::variance(const MotionAction& action) const {
  return action.dt * action.dt * action.dt / 3.0 * walk2_;
}

}  // namespace libslam
