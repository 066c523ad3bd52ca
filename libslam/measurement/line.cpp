#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include <libslam/measurement/line.hpp>

namespace libslam {

namespace {

Eigen::Vector2d direction(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

Eigen::Vector2d left_of(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

/// The sensor in the world.
struct SensorPose {
  double theta;
  Eigen::Vector2d p;
  Eigen::Vector2d from_robot;  // p - p_robot
};

SensorPose sensor_pose(const GaussianState& state, BlockId pose, const Feature& feature) {
  const auto T_world_robot = state.estimate(pose);
  const Eigen::Vector2d from_robot =
      Eigen::Rotation2Dd(T_world_robot[2]) * Eigen::Vector2d(feature.T_robot_sensor.head<2>());
  return {T_world_robot[2] + feature.T_robot_sensor[2], T_world_robot.head<2>() + from_robot,
          from_robot};
}

}  // namespace

BlockSpec LineMeasurement::landmark_spec() const {
  return {"", Chart::kLine, 2, WorldRole::kLine};
}

MeasurementVector LineMeasurement::predict(const GaussianState& state, BlockId pose,
                                           BlockId landmark, const Feature& feature) const {
  const SensorPose sensor = sensor_pose(state, pose, feature);
  const auto line = state.estimate(landmark);
  return Eigen::Vector2d(wrap_angle(line[0] - sensor.theta),
                         line[1] - direction(line[0]).dot(sensor.p));
}

void LineMeasurement::linearize(const GaussianState& state, BlockId pose, BlockId landmark,
                                const Feature& feature, LinearizedMeasurement& out) const {
  const SensorPose sensor = sensor_pose(state, pose, feature);
  const auto line = state.estimate(landmark);
  const Eigen::Vector2d n = direction(line[0]);
  out.innovation.resize(2);
  out.innovation << wrap_angle(feature.z[0] - line[0] + sensor.theta),
      feature.z[1] - line[1] + n.dot(sensor.p);
  out.cov = feature.cov;
  out.wrt.clear();
  out.wrt.add(pose, 2, 3) << 0.0, 0.0, -1.0, -n.x(), -n.y(), -n.dot(left_of(sensor.from_robot));
  out.wrt.add(landmark, 2, 2) << 1.0, 0.0, -left_of(n).dot(sensor.p), 1.0;
}

void LineMeasurement::initialize(const GaussianState& state, BlockId pose, const Feature& feature,
                                 Initialization& out) const {
  const SensorPose sensor = sensor_pose(state, pose, feature);
  const double alpha = wrap_angle(feature.z[0] + sensor.theta);
  const Eigen::Vector2d n = direction(alpha);
  const double lever = left_of(n).dot(sensor.p);
  out.estimate = Eigen::Vector2d(alpha, feature.z[1] + n.dot(sensor.p));
  out.wrt.clear();
  out.wrt.add(pose, 2, 3) << 0.0, 0.0, 1.0, n.x(), n.y(), lever + n.dot(left_of(sensor.from_robot));
  Eigen::Matrix2d by_z;
  by_z << 1.0, 0.0, lever, 1.0;
  out.cov_noise = by_z * feature.cov * by_z.transpose();
}

namespace {

/// The ends of `part`, which lies along the line (n, r), along another line with the normal
/// `other`.
Extent drop_onto(const Eigen::Vector2d& other, const Eigen::Vector2d& foot,
                 const Eigen::Vector2d& n, const Extent& part) {
  const Eigen::Vector2d along = left_of(other);
  const double shift = along.dot(foot), stretch = along.dot(left_of(n));
  Extent dropped{shift + stretch * part.begin, shift + stretch * part.end, part.sigma_begin,
                 part.sigma_end};
  if (dropped.begin > dropped.end) {
    std::swap(dropped.begin, dropped.end);
    std::swap(dropped.sigma_begin, dropped.sigma_end);
  }
  return dropped;
}

}  // namespace

std::optional<Extent> LineMeasurement::sighted_part(const GaussianState& state, BlockId pose,
                                                    BlockId landmark,
                                                    const Feature& feature) const {
  if (!feature.extent) return std::nullopt;
  const SensorPose sensor = sensor_pose(state, pose, feature);
  const Eigen::Vector2d n = direction(feature.z[0] + sensor.theta);
  return drop_onto(direction(state.estimate(landmark)[0]), sensor.p + feature.z[1] * n, n,
                   *feature.extent);
}

std::optional<Extent> LineMeasurement::part_along(const GaussianState& state, BlockId landmark,
                                                  const LandmarkPart& part) const {
  const auto line = state.estimate(part.block);
  const Eigen::Vector2d n = direction(line[0]);
  return drop_onto(direction(state.estimate(landmark)[0]), line[1] * n, n, part.extent);
}

bool LineMeasurement::difference(const GaussianState& state, const LandmarkPart& a,
                                 const LandmarkPart& b, double extent_gap,
                                 LinearizedMeasurement& out) const {
  const auto first = state.estimate(a.block), second = state.estimate(b.block);
  const double turn = wrap_angle(first[0] - second[0]);
  if (std::abs(turn) > kMaxTurn) return false;
  const Extent part = *part_along(state, a.block, b);
  if (part.gap_to(a.extent) > extent_gap) return false;
  const double middle =
      0.5 * (std::max(part.begin, a.extent.begin) + std::min(part.end, a.extent.end));
  out.innovation.resize(2);
  out.innovation << -turn, second[1] - first[1];
  out.wrt.clear();
  out.wrt.add(a.block, 2, 2).setIdentity();
  out.wrt.add(b.block, 2, 2) = -Eigen::Matrix2d::Identity();
  Eigen::Matrix2d to_foot;
  to_foot << 1.0, 0.0, middle, 1.0;
  const Eigen::Vector2d variance =
      Eigen::Vector2d(tolerance_.sigma_alpha, tolerance_.sigma_r).cwiseAbs2();
  out.cov = to_foot * variance.asDiagonal() * to_foot.transpose();
  return true;
}

}  // namespace libslam
