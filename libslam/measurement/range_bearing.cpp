#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <libslam/measurement/range_bearing.hpp>

namespace libslam {

namespace {

constexpr double kSmallestRange = 1e-6;

struct Geometry {
  Eigen::Matrix2d R_world_sensor;
  Eigen::Vector2d from_robot;  // landmark - robot, world frame
  Eigen::Vector2d l_sensor;    // landmark in the sensor frame
};

Geometry geometry_of(const GaussianState& state, BlockId pose, BlockId landmark,
                     const Feature& feature) {
  const auto T_world_robot = state.estimate(pose);
  const Eigen::Vector3d& T_robot_sensor = feature.T_robot_sensor;
  Geometry g;
  g.R_world_sensor = Eigen::Rotation2Dd(T_world_robot[2] + T_robot_sensor[2]).toRotationMatrix();
  g.from_robot = state.estimate(landmark) - T_world_robot.head<2>();
  g.l_sensor = g.R_world_sensor.transpose() * g.from_robot -
               Eigen::Rotation2Dd(-T_robot_sensor[2]) * Eigen::Vector2d(T_robot_sensor.head<2>());
  return g;
}

Eigen::Vector2d polar(const Eigen::Vector2d& l) {
  return {l.norm(), std::atan2(l.y(), l.x())};
}

}  // namespace

BlockSpec RangeBearing::landmark_spec() const {
  return {"", Chart::kVector, 2, WorldRole::kPoint};
}

MeasurementVector RangeBearing::predict(const GaussianState& state, BlockId pose, BlockId landmark,
                                        const Feature& feature) const {
  return polar(geometry_of(state, pose, landmark, feature).l_sensor);
}

void RangeBearing::linearize(const GaussianState& state, BlockId pose, BlockId landmark,
                             const Feature& feature, LinearizedMeasurement& out) const {
  const Geometry g = geometry_of(state, pose, landmark, feature);
  const Eigen::Vector2d h = polar(g.l_sensor);
  out.innovation.resize(2);
  out.innovation << feature.z[0] - h[0], wrap_angle(feature.z[1] - h[1]);
  out.cov = feature.cov;

  const double range = std::max(h[0], kSmallestRange);
  const Eigen::Vector2d unit(std::cos(h[1]), std::sin(h[1]));
  Eigen::Matrix2d h_by_l;
  h_by_l << unit.x(), unit.y(), -unit.y() / range, unit.x() / range;
  const Eigen::Matrix2d h_by_landmark = h_by_l * g.R_world_sensor.transpose();
  // d l_sensor / d heading = -J R^T (m - p), J = rotation by +90 degrees.
  const Eigen::Vector2d seen = g.R_world_sensor.transpose() * g.from_robot;

  out.wrt.clear();
  BlockMatrix& by_pose = out.wrt.add(pose, 2, 3);
  by_pose.leftCols<2>() = -h_by_landmark;
  by_pose.col(2) = h_by_l * Eigen::Vector2d(seen.y(), -seen.x());
  out.wrt.add(landmark, 2, 2) = h_by_landmark;
}

void RangeBearing::initialize(const GaussianState& state, BlockId pose, const Feature& feature,
                              Initialization& out) const {
  const auto T_world_robot = state.estimate(pose);
  const double range = feature.z[0];
  const double angle = T_world_robot[2] + feature.T_robot_sensor[2] + feature.z[1];
  const Eigen::Vector2d beam(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d from_robot =
      Eigen::Rotation2Dd(T_world_robot[2]) * Eigen::Vector2d(feature.T_robot_sensor.head<2>()) +
      range * beam;
  out.estimate = T_world_robot.head<2>() + from_robot;
  out.wrt.clear();
  BlockMatrix& by_pose = out.wrt.add(pose, 2, 3);
  by_pose << 1.0, 0.0, -from_robot.y(), 0.0, 1.0, from_robot.x();
  Eigen::Matrix2d by_z;
  by_z << beam.x(), -range * beam.y(), beam.y(), range * beam.x();
  out.cov_noise = by_z * feature.cov * by_z.transpose();
}

}  // namespace libslam
