#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Eigenvalues>

#include <libslam/motion/arc.hpp>
#include <libslam/motion/body_increment_model.hpp>

namespace libslam {

namespace {

NoiseVector draw_standard_normal(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  NoiseVector draw;
  for (double& value : draw) value = normal(random);
  return draw;
}

/// A square root of a covariance that may be singular.
Eigen::Matrix3d square_root(const Eigen::Matrix3d& cov) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(cov);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace

Eigen::Vector3d compose_increment(const Eigen::Vector3d& pose, const Eigen::Vector3d& increment) {
  Eigen::Vector3d moved = pose + rotate_planar(pose[2]) * increment;
  moved[2] = wrap_angle(moved[2]);
  return moved;
}

void BodyIncrementModel::require_values(Eigen::Index count) const {
  const auto expected = static_cast<Eigen::Index>(layout_.indices().size());
  if (count != expected) {
    throw std::invalid_argument("motion model estimates " + std::to_string(expected) +
                                " calibration parameters, got " + std::to_string(count));
  }
}

void BodyIncrementModel::linearize(const GaussianState& state, BlockId pose,
                                   const CalibrationBlocks& blocks, const MotionAction& action,
                                   MotionStep& step) const {
  require_values(static_cast<Eigen::Index>(blocks.size()));
  CalibrationVector values = layout_.priors();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    values[layout_.indices()[i]] = state.estimate(blocks[i])[0];
  }
  const BodyIncrement body = linearize_increment(values, action);
  const Eigen::Vector3d before = state.estimate(pose);
  const Eigen::Matrix3d rotation = rotate_planar(before[2]);
  const Eigen::Vector2d moved = rotation.topLeftCorner<2, 2>() * body.mean.head<2>();

  step.target = pose;
  step.estimate = compose_increment(before, body.mean);
  step.wrt.clear();
  BlockMatrix& wrt_pose = step.wrt.add(pose, 3, 3);
  wrt_pose.setIdentity();
  wrt_pose(0, 2) = -moved.y();
  wrt_pose(1, 2) = moved.x();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    step.wrt.add(blocks[i], 3, 1) = rotation * body.wrt_calibration.col(layout_.indices()[i]);
  }
  const Eigen::Matrix3d cov_body =
      uses_log_covariance(action) ? *action.cov_increment
                                  : Eigen::Matrix3d(body.wrt_noise * body.variance.asDiagonal() *
                                                    body.wrt_noise.transpose());
  step.cov_noise = rotation * cov_body * rotation.transpose();
}

BlockVector BodyIncrementModel::sample(const BlockVector& pose, const Eigen::VectorXd& calibration,
                                       const MotionAction& action, std::mt19937_64& random) const {
  require_values(calibration.size());
  CalibrationVector values = layout_.priors();
  for (std::size_t i = 0; i < layout_.indices().size(); ++i) {
    values[layout_.indices()[i]] = calibration[static_cast<Eigen::Index>(i)];
  }
  const BodyIncrement body = linearize_increment(values, action);
  // The same number of draws on every path keeps the streams of particles comparable.
  const NoiseVector draw = draw_standard_normal(random);
  const Eigen::Vector3d increment =
      uses_log_covariance(action)
          ? Eigen::Vector3d(body.mean + square_root(*action.cov_increment) * draw.head<3>())
          : perturb_increment(values, action, body.variance.cwiseSqrt().cwiseProduct(draw));
  return compose_increment(pose, increment);
}

}  // namespace libslam
