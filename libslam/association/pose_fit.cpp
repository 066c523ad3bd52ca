#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <libslam/association/pose_fit.hpp>
#include <libslam/state/block.hpp>

namespace libslam {

namespace {

/// Residuals are nearly linear in the pose, so that the third step is below a micrometre.
constexpr int kSteps = 4;

}  // namespace

Eigen::Matrix2d rotation_of(const Eigen::Vector3d& pose) {
  return Eigen::Rotation2Dd(pose[2]).toRotationMatrix();
}

PointResidual::PointResidual(const PlanarPoint& seen, const PlanarPoint& landmark,
                             const Eigen::Vector3d& pose, const Eigen::Matrix2d& rotation)
    : e(landmark.position - rotation * seen.position - pose.head<2>()),
      s(landmark.cov + rotation * seen.cov * rotation.transpose()) {}

double PointResidual::mahalanobis2() const {
  return e.dot(s.inverse() * e);
}

PoseFit fit_pose(std::span<const PointPair> pairs, const Eigen::Vector3d& start) {
  PoseFit fit;
  fit.T_world_robot = start;
  Eigen::Matrix3d information;
  for (int step = 0; step <= kSteps; ++step) {
    const Eigen::Matrix2d rotation = rotation_of(fit.T_world_robot);
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    information.setZero();
    fit.mahalanobis2 = fit.log_likelihood = 0.0;
    for (const auto& [seen, landmark] : pairs) {
      const PointResidual residual(*seen, *landmark, fit.T_world_robot, rotation);
      const Eigen::Matrix2d weight = residual.s.inverse();
      const Eigen::Vector2d arm = rotation * seen->position;
      Eigen::Matrix<double, 2, 3> jacobian;
      jacobian << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
      information += jacobian.transpose() * weight * jacobian;
      gradient += jacobian.transpose() * (weight * residual.e);
      const double distance2 = residual.e.dot(weight * residual.e);
      fit.mahalanobis2 += distance2;
      fit.log_likelihood -=
          0.5 * (distance2 + std::log(residual.s.determinant())) + std::log(2.0 * std::numbers::pi);
    }
    if (step == kSteps) break;
    fit.T_world_robot += information.ldlt().solve(gradient);
    fit.T_world_robot[2] = wrap_angle(fit.T_world_robot[2]);
  }
  fit.cov = information.inverse();
  return fit;
}

PoseFit fit_pose(std::span<const PointPair> pairs, const Eigen::MatrixXd& cov_landmarks,
                 const Eigen::Vector3d& start) {
  const auto rows = 2 * static_cast<Eigen::Index>(pairs.size());
  PoseFit fit;
  fit.T_world_robot = start;
  Eigen::VectorXd e(rows);
  Eigen::MatrixX3d jacobian(rows, 3);
  for (int step = 0; step <= kSteps; ++step) {
    const Eigen::Matrix2d rotation = rotation_of(fit.T_world_robot);
    Eigen::MatrixXd s = cov_landmarks;
    for (Eigen::Index row = 0; const auto& [seen, landmark] : pairs) {
      const Eigen::Vector2d arm = rotation * seen->position;
      e.segment<2>(row) = landmark->position - arm - fit.T_world_robot.head<2>();
      jacobian.middleRows<2>(row) << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
      s.block<2, 2>(row, row) += rotation * seen->cov * rotation.transpose();
      row += 2;
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(s);
    const Eigen::VectorXd white = factor.matrixL().solve(e);
    const Eigen::MatrixX3d white_jacobian = factor.matrixL().solve(jacobian);
    const Eigen::Matrix3d information = white_jacobian.transpose() * white_jacobian;
    fit.cov = information.inverse();
    fit.mahalanobis2 = factor.info() == Eigen::Success ? white.squaredNorm()
                                                       : std::numeric_limits<double>::infinity();
    fit.log_likelihood = -0.5 * fit.mahalanobis2 -
                         factor.matrixLLT().diagonal().array().log().sum() -
                         0.5 * static_cast<double>(rows) * std::log(2.0 * std::numbers::pi);
    if (step == kSteps) break;
    fit.T_world_robot += information.ldlt().solve(white_jacobian.transpose() * white);
    fit.T_world_robot[2] = wrap_angle(fit.T_world_robot[2]);
  }
  return fit;
}

}  // namespace libslam
