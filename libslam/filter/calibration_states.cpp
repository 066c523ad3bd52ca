#include <cmath>

#include <Eigen/Geometry>

#include <libslam/filter/calibration_states.hpp>

namespace libslam {

namespace {

/// A parameter counts as observed when the data halved its standard deviation.
constexpr double kObservedRatio = 0.5;

/// Scales for the excitation: the motion itself is what shows the pose of a sensor.
std::vector<double> nominal_values(const MotionModel& motion, const DisplacementModel* sensor) {
  std::vector<double> nominal;
  for (const auto& parameter : motion.calibration())
    nominal.push_back(parameter.prior_mean == 0.0 ? parameter.prior_sigma : parameter.prior_mean);
  if (sensor != nullptr) nominal.resize(nominal.size() + sensor->calibration().size(), 1.0);
  return nominal;
}

std::vector<CalibrationSpec> all_parameters(const MotionModel& motion,
                                            const DisplacementModel* sensor) {
  std::vector<CalibrationSpec> parameters = motion.calibration();
  if (sensor != nullptr)
    parameters.insert(parameters.end(), sensor->calibration().begin(), sensor->calibration().end());
  return parameters;
}

}  // namespace

CalibrationStates::CalibrationStates(const MotionModel& motion, const DisplacementModel* sensor)
    : parameters_(all_parameters(motion, sensor)),
      motion_count_(motion.calibration().size()),
      excitation_(nominal_values(motion, sensor)),
      jacobian_(3, static_cast<Eigen::Index>(parameters_.size())) {}

void CalibrationStates::add_to(GaussianState& state, Linearizer& linearizer) {
  for (const CalibrationSpec& parameter : parameters_) {
    blocks_.push_back(
        state.add({parameter.name, Chart::kVector, 1, WorldRole::kNone},
                  Eigen::VectorXd::Constant(1, parameter.prior_mean),
                  Eigen::MatrixXd::Constant(1, 1, parameter.prior_sigma * parameter.prior_sigma)));
    (blocks_.size() <= motion_count_ ? motion_ : sensor_).push_back(blocks_.back());
    linearizer.add_block(state, blocks_.back());
  }
}

void CalibrationStates::observe(const GaussianState& state, BlockId pose, const MotionStep& step,
                                double dt, const DisplacementModel* sensor) {
  // Additive inputs of poses in space need no excitation: every step shows them.
  if (state.spec(pose).chart != Chart::kSE2) return;
  const Eigen::Rotation2Dd R_robot_world(-state.estimate(pose)[2]);
  Eigen::Matrix3d to_robot = Eigen::Matrix3d::Identity();
  to_robot.topLeftCorner<2, 2>() = R_robot_world.toRotationMatrix();
  jacobian_.setZero();
  for (const auto& [block, jacobian] : step.wrt)
    for (std::size_t i = 0; i < blocks_.size(); ++i)
      if (block == blocks_[i]) jacobian_.col(static_cast<Eigen::Index>(i)) = to_robot * jacobian;
  if (sensor != nullptr) {
    Eigen::Vector3d moved = to_robot * (step.estimate - state.estimate(pose));
    moved[2] = wrap_angle(moved[2]);
    jacobian_.rightCols(static_cast<Eigen::Index>(sensor_.size())) = sensor->excitation(moved);
  }
  excitation_.observe(jacobian_, to_robot * step.cov_noise * to_robot.transpose(), dt);
  consider();
}

void CalibrationStates::consider() {
  watched_ = true;
  considered_.clear();
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    if (!excitation_.excited(i)) considered_.push_back(blocks_[i]);
}

std::vector<double> CalibrationStates::memory() const {
  return watched_ ? excitation_.memory() : std::vector<double>();
}

void CalibrationStates::remember(std::span<const double> memory) {
  if (memory.empty()) return;
  excitation_.remember(memory);
  consider();
}

void CalibrationStates::diffuse(GaussianState& state, double dt) const {
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const double walk = parameters_[i].random_walk;
    if (walk > 0.0 && dt > 0.0)
      state.covariance().add_noise(state.offset(blocks_[i]),
                                   BlockMatrix::Constant(1, 1, walk * walk * dt));
  }
}

std::vector<CalibrationValue> CalibrationStates::values(const GaussianState& state) const {
  std::vector<CalibrationValue> values;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const CalibrationSpec& parameter = parameters_[i];
    const double sigma = std::sqrt(state.covariance_of(blocks_[i])(0, 0));
    const bool excited = parameter.additive || excitation_.ever_excited(i);
    values.push_back({parameter.name, state.estimate(blocks_[i])[0], sigma, parameter.prior_mean,
                      parameter.prior_sigma,
                      excited && sigma < kObservedRatio * parameter.prior_sigma});
  }
  return values;
}

bool CalibrationStates::healthy(const GaussianState& state) const {
  for (const BlockId block : blocks_) {
    const double variance = state.covariance_of(block)(0, 0);
    if (!state.estimate(block).allFinite() || !std::isfinite(variance) || variance < 0.0)
      return false;
  }
  return true;
}

}  // namespace libslam
