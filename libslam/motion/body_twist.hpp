#pragma once
// Motion in space from measured body velocities (twist_model.hpp).
//
//   v = s v_measured,   w = w_measured - b
//
// with the speed factor s (calibration.scale_speed) and the gyro bias b [rad/s]
// (calibration.bias_gyro_x, _y, _z), each a state or a constant. Input: MotionAction::twist.
// Noise: TwistParameters, from the readings and by density.

#include <libslam/config/parameters.hpp>
#include <libslam/motion/twist_model.hpp>

namespace libslam {

class BodyTwist final : public TwistModel {
 public:
  BodyTwist(const TwistParameters& noise, const CalibrationParameters& calibration);

 private:
  /// A calibration parameter that is a state.
  enum class Parameter { kScaleSpeed, kBiasX, kBiasY, kBiasZ };
  struct Layout {
    std::vector<CalibrationSpec> specs;
    std::vector<Parameter> parameters;
  };
  static Layout layout_of(const CalibrationParameters& calibration);
  BodyTwist(Layout layout, const TwistParameters& noise, const CalibrationParameters& calibration);

  Twist reference(const MotionAction& action) const override;
  Twist derivative(const MotionAction& action, std::size_t parameter) const override;
  Twist variance(const MotionAction& action) const override;

  std::vector<Parameter> parameters_;
  double scale_;          // 0 where it is a state
  Eigen::Vector3d bias_;  // its coordinates that are states are 0
  Twist variance_of_reading_, density2_;
};

}  // namespace libslam
