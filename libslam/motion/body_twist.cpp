#include <stdexcept>
#include <string>

#include <libslam/motion/body_twist.hpp>

namespace libslam {

namespace {

const Twist& twist_of(const MotionAction& action) {
  if (!action.twist)
    throw std::invalid_argument("odometry step at " + std::to_string(action.time) +
                                " s has no body velocity, which the motion model needs "
                                "(input.odometry: twist)");
  return *action.twist;
}

double constant_part(const CalibrationParameter& parameter) {
  return parameter.enabled ? 0.0 : parameter.prior_mean;
}

}  // namespace

BodyTwist::Layout BodyTwist::layout_of(const CalibrationParameters& c) {
  Layout layout;
  const auto add = [&](Parameter parameter, const char* name, const CalibrationParameter& p) {
    if (!p.enabled) return;
    layout.specs.push_back({name, p.prior_mean, p.prior_sigma, p.random_walk_per_sqrt_s,
                            parameter != Parameter::kScaleSpeed});
    layout.parameters.push_back(parameter);
  };
  add(Parameter::kScaleSpeed, "scale_speed", c.scale_speed);
  add(Parameter::kBiasX, "bias_gyro_x", c.bias_gyro_x);
  add(Parameter::kBiasY, "bias_gyro_y", c.bias_gyro_y);
  add(Parameter::kBiasZ, "bias_gyro_z", c.bias_gyro_z);
  return layout;
}

BodyTwist::BodyTwist(const TwistParameters& noise, const CalibrationParameters& calibration)
    : BodyTwist(layout_of(calibration), noise, calibration) {}

BodyTwist::BodyTwist(Layout layout, const TwistParameters& noise, const CalibrationParameters& c)
    : TwistModel(std::move(layout.specs)),
      parameters_(std::move(layout.parameters)),
      scale_(constant_part(c.scale_speed)),
      bias_(constant_part(c.bias_gyro_x), constant_part(c.bias_gyro_y),
            constant_part(c.bias_gyro_z)) {
  Twist sigma, density;
  sigma << noise.sigma_speed_x, noise.sigma_speed_y, noise.sigma_speed_z, noise.sigma_rate_x,
      noise.sigma_rate_y, noise.sigma_rate_z;
  density << Eigen::Vector3d::Constant(noise.speed_per_sqrt_s),
      Eigen::Vector3d::Constant(noise.rate_per_sqrt_s);
  variance_of_reading_ = sigma.cwiseAbs2();
  density2_ = density.cwiseAbs2();
}

Twist BodyTwist::reference(const MotionAction& action) const {
  Twist twist = twist_of(action);
  twist.head<3>() *= scale_;
  twist.tail<3>() -= bias_;
  return twist;
}

Twist BodyTwist::derivative(const MotionAction& action, std::size_t parameter) const {
  Twist column = Twist::Zero();
  if (parameters_[parameter] == Parameter::kScaleSpeed)
    column.head<3>() = twist_of(action).head<3>();
  else
    column[2 + static_cast<int>(parameters_[parameter])] = -1.0;
  return column;
}

Twist BodyTwist::variance(const MotionAction& action) const {
  const double hold = action.hold > 0.0 ? action.hold : action.dt;
  return hold * action.dt * variance_of_reading_ + action.dt * density2_;
}

}  // namespace libslam
