#include <Eigen/Dense>

#include <libslam/result/spatial_alignment.hpp>
#include <libslam/state/block.hpp>

namespace libslam {
namespace {

Eigen::Matrix<double, 7, 1> storage_of(const SpatialPose& pose) {
  Eigen::Matrix<double, 7, 1> storage;
  storage << pose.position, pose.rotation.coeffs();
  return storage;
}

}  // namespace

Eigen::Isometry3d place_on(const SpatialPose& estimate, const SpatialPose& truth) {
  return truth.isometry() * estimate.isometry().inverse();
}

std::optional<Eigen::Isometry3d> fit_rigid_in_space(const Eigen::Matrix3Xd& estimate,
                                                    const Eigen::Matrix3Xd& truth) {
  if (estimate.cols() < 3) return std::nullopt;
  // Dynamic sizes: with fixed rows GCC 12 warns falsely inside Eigen (stringop-overread).
  const Eigen::MatrixXd from = estimate, to = truth;
  const Eigen::Matrix4d T = Eigen::umeyama(from, to, false);
  return Eigen::Isometry3d(T);
}

SpatialPose transform_pose(const Eigen::Isometry3d& T, const SpatialPose& pose) {
  return {T * pose.position, Eigen::Quaterniond(T.linear()) * pose.rotation};
}

Eigen::Matrix<double, 6, 1> pose_difference(const SpatialPose& a, const SpatialPose& b) {
  static const BlockSpec kPose{"pose", Chart::kSE3, 6, WorldRole::kPose};
  return boxminus(kPose, storage_of(a), storage_of(b));
}

std::vector<SpatialEstimate> path_of_point(std::span<const SpatialEstimate> robot,
                                           const Eigen::Vector2d& point) {
  std::vector<SpatialEstimate> moved(robot.begin(), robot.end());
  for (SpatialEstimate& step : moved)
    step.pose.position += step.pose.rotation * Eigen::Vector3d(point.x(), point.y(), 0.0);
  return moved;
}

std::vector<SpatialPose> lift_to_space(std::span<const Eigen::Vector3d> poses) {
  std::vector<SpatialPose> lifted;
  lifted.reserve(poses.size());
  for (const Eigen::Vector3d& pose : poses)
    lifted.push_back({{pose.x(), pose.y(), 0.0},
                      Eigen::Quaterniond(Eigen::AngleAxisd(pose.z(), Eigen::Vector3d::UnitZ()))});
  return lifted;
}

}  // namespace libslam
