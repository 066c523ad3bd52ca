#include <array>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include <libslam/measurement/sensor_displacement.hpp>

namespace libslam {

namespace {

Eigen::Matrix2d rotation(double angle) {
  return Eigen::Rotation2Dd(angle).toRotationMatrix();
}

Eigen::Vector2d rotated_90(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

/// Pose of `to` in the frame of `from`, heading wrapped.
Eigen::Vector3d relative_pose(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Eigen::Vector3d relative;
  relative.head<2>() = rotation(-from[2]) * (to - from).head<2>();
  relative[2] = wrap_angle(to[2] - from[2]);
  return relative;
}

/// Displacement of a sensor at `T_robot_sensor` on a robot that moved by `moved`.
Eigen::Vector3d seen_by_sensor(const Eigen::Vector3d& moved,
                               const Eigen::Vector3d& T_robot_sensor) {
  const Eigen::Vector2d lever = T_robot_sensor.head<2>();
  Eigen::Vector3d seen;
  seen.head<2>() =
      rotation(-T_robot_sensor[2]) * (rotation(moved[2]) * lever + moved.head<2>() - lever);
  seen[2] = moved[2];
  return seen;
}

}  // namespace

SensorDisplacement::SensorDisplacement(const CalibrationParameters& calibration)
    : T_robot_sensor_(calibration.sensor_x.prior_mean, calibration.sensor_y.prior_mean,
                      calibration.sensor_phi.prior_mean) {
  const std::array<std::pair<const char*, const CalibrationParameter*>, 3> parameters{
      {{"sensor_x", &calibration.sensor_x},
       {"sensor_y", &calibration.sensor_y},
       {"sensor_phi", &calibration.sensor_phi}}};
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto& [name, parameter] = parameters[i];
    if (!parameter->enabled) continue;
    specs_.push_back(
        {name, parameter->prior_mean, parameter->prior_sigma, parameter->random_walk_per_sqrt_s});
    indices_.push_back(static_cast<Eigen::Index>(i));
  }
}

Eigen::Vector3d SensorDisplacement::sensor_pose(const GaussianState& state,
                                                const CalibrationBlocks& blocks) const {
  if (blocks.size() != specs_.size())
    throw std::invalid_argument("sensor displacement estimates " + std::to_string(specs_.size()) +
                                " calibration parameters, got " + std::to_string(blocks.size()));
  Eigen::Vector3d pose = T_robot_sensor_;
  for (std::size_t i = 0; i < blocks.size(); ++i) pose[indices_[i]] = state.estimate(blocks[i])[0];
  return pose;
}

MeasurementVector SensorDisplacement::predict(const GaussianState& state, const PosePair& poses,
                                              const CalibrationBlocks& blocks) const {
  return seen_by_sensor(relative_pose(state.estimate(poses.before), state.estimate(poses.now)),
                        sensor_pose(state, blocks));
}

void SensorDisplacement::linearize(const GaussianState& state, const PosePair& poses,
                                   const CalibrationBlocks& blocks, const Feature& before,
                                   const Feature& now, LinearizedMeasurement& out) const {
  const Eigen::Vector3d sensor = sensor_pose(state, blocks);
  const Eigen::Vector3d from = state.estimate(poses.before);
  const Eigen::Vector3d moved = relative_pose(from, state.estimate(poses.now));
  const Eigen::Vector3d predicted = seen_by_sensor(moved, sensor);
  const Eigen::Vector3d measured = relative_pose(before.z, now.z);
  out.innovation = measured - predicted;
  out.innovation[2] = wrap_angle(out.innovation[2]);
  out.cov = now.cov;

  const Eigen::Matrix2d R_sensor_robot = rotation(-sensor[2]);
  const Eigen::Matrix2d R_sensor_world = R_sensor_robot * rotation(-from[2]);
  const Eigen::Vector2d lever = sensor.head<2>();
  const Eigen::Vector2d swing = rotated_90(rotation(moved[2]) * lever);  // d (R(dphi) l) / d dphi
  out.wrt.clear();
  BlockMatrix& by_now = out.wrt.add(poses.now, 3, 3);
  by_now.topLeftCorner<2, 2>() = R_sensor_world;
  by_now.topRightCorner<2, 1>() = R_sensor_robot * swing;
  by_now(2, 2) = 1.0;
  BlockMatrix& by_before = out.wrt.add(poses.before, 3, 3);
  by_before.topLeftCorner<2, 2>() = -R_sensor_world;
  by_before.topRightCorner<2, 1>() = -R_sensor_robot * (swing + rotated_90(moved.head<2>()));
  by_before(2, 2) = -1.0;

  Eigen::Matrix3d by_sensor = Eigen::Matrix3d::Zero();
  by_sensor.topLeftCorner<2, 2>() = R_sensor_robot * (rotation(moved[2]) - rotation(0.0));
  by_sensor.topRightCorner<2, 1>() = -rotated_90(predicted.head<2>());
  for (std::size_t i = 0; i < blocks.size(); ++i)
    out.wrt.add(blocks[i], 3, 1) = by_sensor.col(indices_[i]);
}

Eigen::Matrix3Xd SensorDisplacement::excitation(const Eigen::Vector3d& movement) const {
  const Eigen::Vector3d turn(0.0, 0.0, movement[2]);
  const Eigen::Vector3d translation(movement[0], movement[1], 0.0);
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(indices_.size()));
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    columns.col(i) = indices_[static_cast<std::size_t>(i)] == 2 ? translation : turn;
  return columns;
}

}  // namespace libslam
