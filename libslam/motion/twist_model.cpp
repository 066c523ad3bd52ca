#include <stdexcept>
#include <string>

#include <libslam/motion/twist_model.hpp>
#include <libslam/state/so3.hpp>

namespace libslam {

namespace {

using ParameterValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, BlockJacobians::kCapacity, 1>;

Eigen::Quaterniond rotation_of(const BlockVector& pose) {
  return {pose[6], pose[3], pose[4], pose[5]};
}

/// The pose after the displacement u = (v dt, w dt).
BlockVector moved(const BlockVector& pose, const Twist& u) {
  const Eigen::Quaterniond R = rotation_of(pose);
  BlockVector after(7);
  after.head<3>() = pose.head<3>() + R * (so3_left_jacobian(u.tail<3>()) * u.head<3>());
  after.tail<4>() = (R * so3_exp(u.tail<3>())).normalized().coeffs();
  return after;
}

/// F_u of the header.
Eigen::Matrix<double, 6, 6> derivative_by_displacement(const Eigen::Matrix3d& R, const Twist& u) {
  const Eigen::Matrix3d RV = R * so3_left_jacobian(u.tail<3>());
  Eigen::Matrix<double, 6, 6> G = Eigen::Matrix<double, 6, 6>::Zero();
  G.topLeftCorner<3, 3>() = RV;
  G.topRightCorner<3, 3>() = R * so3_left_jacobian_derivative(u.tail<3>(), u.head<3>());
  G.bottomRightCorner<3, 3>() = RV;
  return G;
}

}  // namespace

void TwistModel::require_values(Eigen::Index count) const {
  const auto expected = static_cast<Eigen::Index>(specs_.size());
  if (count != expected)
    throw std::invalid_argument("motion model estimates " + std::to_string(expected) +
                                " calibration parameters, got " + std::to_string(count));
}

Twist TwistModel::displacement(const MotionAction& action, const VectorRef& values) const {
  Twist twist = reference(action);
  for (std::size_t i = 0; i < specs_.size(); ++i)
    twist += values[static_cast<Eigen::Index>(i)] * derivative(action, i);
  return action.dt * twist;
}

void TwistModel::linearize(const GaussianState& state, BlockId pose,
                           const CalibrationBlocks& blocks, const MotionAction& action,
                           MotionStep& step) const {
  require_values(static_cast<Eigen::Index>(blocks.size()));
  ParameterValues values(static_cast<Eigen::Index>(blocks.size()));
  for (std::size_t i = 0; i < blocks.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = state.estimate(blocks[i])[0];
  const Twist u = displacement(action, values);
  const BlockVector before = state.estimate(pose);
  const Eigen::Matrix<double, 6, 6> G =
      derivative_by_displacement(rotation_of(before).toRotationMatrix(), u);

  step.target = pose;
  step.estimate = moved(before, u);
  step.wrt.clear();
  BlockMatrix& wrt_pose = step.wrt.add(pose, 6, 6);
  wrt_pose.setIdentity();
  wrt_pose.topRightCorner<3, 3>() = skew(before.head<3>() - step.estimate.head<3>());
  for (std::size_t i = 0; i < blocks.size(); ++i)
    step.wrt.add(blocks[i], 6, 1) = action.dt * (G * derivative(action, i));
  step.cov_noise = G * variance(action).asDiagonal() * G.transpose();
}

BlockVector TwistModel::sample(const BlockVector& pose, const Eigen::VectorXd& calibration,
                               const MotionAction& action, std::mt19937_64& random) const {
  require_values(calibration.size());
  Twist u = displacement(action, calibration);
  const Twist sigma = variance(action).cwiseSqrt();
  std::normal_distribution<double> normal;
  for (Eigen::Index i = 0; i < u.size(); ++i) u[i] += sigma[i] * normal(random);
  return moved(pose, u);
}

}  // namespace libslam
