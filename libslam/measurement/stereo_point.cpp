#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include <libslam/measurement/stereo_point.hpp>
#include <libslam/state/so3.hpp>

namespace libslam {

namespace {

/// Nearer points are not in front of the camera [m].
constexpr double kSmallestDepth = 1e-3;
/// Smallest disparity over its standard deviation that a landmark starts from.
constexpr double kKnownDisparity = 3.0;
/// Cosine of the largest tilt of a level camera: 1.4 mrad.
constexpr double kLevel = 1.0 - 1e-6;

// The rows of (u, v, d) that a planar landmark is measured by.
constexpr std::array<Eigen::Index, 2> kPlanarRows = {0, 2};

const StereoCamera& camera_of(const Feature& feature) {
  if (!feature.camera) throw std::invalid_argument("a stereo point without a camera");
  return *feature.camera;
}

Eigen::Isometry3d robot_pose(const GaussianState& state, BlockId pose) {
  const auto x = state.estimate(pose);
  if (state.spec(pose).chart == Chart::kSE3)
    return Eigen::Translation3d(x.head<3>()) * Eigen::Quaterniond(x[6], x[3], x[4], x[5]);
  return Eigen::Translation3d(x[0], x[1], 0.0) * Eigen::AngleAxisd(x[2], Eigen::Vector3d::UnitZ());
}

/// The derivative of a point fixed to the robot at `from_robot` (world axes) by the pose error.
Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 6> point_by_pose(const GaussianState& state,
                                                                BlockId pose,
                                                                const Eigen::Vector3d& from_robot) {
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 6> J(3, state.size(pose));
  const Eigen::Matrix3d by_turn = -skew(from_robot);
  if (J.cols() == 6)
    J << Eigen::Matrix3d::Identity(), by_turn;
  else
    J << Eigen::Matrix3d::Identity().leftCols<2>(), by_turn.col(2);
  return J;
}

bool visible(const Eigen::Vector3d& p_camera) {
  return p_camera.z() >= kSmallestDepth;
}

/// A landmark in space; a planar one is put at the height of the camera, where it does no harm.
Eigen::Vector3d place_of(const GaussianState& state, BlockId landmark,
                         const Eigen::Isometry3d& T_world_camera) {
  const auto m = state.estimate(landmark);
  if (m.size() == 3) return m;
  return {m[0], m[1], T_world_camera.translation().z()};
}

}  // namespace

StereoPoint::StereoPoint(int dimension) : dimension_(dimension) {
  if (dimension != 2 && dimension != 3)
    throw std::invalid_argument("landmarks have 2 or 3 coordinates, not " +
                                std::to_string(dimension));
}

BlockSpec StereoPoint::landmark_spec() const {
  return {"", Chart::kVector, dimension_, WorldRole::kPoint};
}

void StereoPoint::check(const GaussianState& state, BlockId pose, const Feature& feature) const {
  if (dimension_ == 3) return;
  if (state.spec(pose).chart == Chart::kSE3)
    throw std::invalid_argument("a robot in space needs landmarks with 3 coordinates");
  const double down = -camera_of(feature).T_robot_camera.linear()(2, 1);
  if (down < kLevel)
    throw std::invalid_argument(
        "landmarks with 2 coordinates need a level camera; this one is "
        "tilted by " +
        std::to_string(std::acos(down)) + " rad");
}

MeasurementVector StereoPoint::predict(const GaussianState& state, BlockId pose, BlockId landmark,
                                       const Feature& feature) const {
  check(state, pose, feature);
  const StereoCamera& camera = camera_of(feature);
  const Eigen::Isometry3d T_world_camera = robot_pose(state, pose) * camera.T_robot_camera;
  const Eigen::Vector3d p_camera =
      T_world_camera.inverse() * place_of(state, landmark, T_world_camera);
  if (!visible(p_camera))
    return MeasurementVector::Constant(dimension_, std::numeric_limits<double>::quiet_NaN());
  const Eigen::Vector3d z = project(camera, p_camera);
  if (dimension_ == 2) return z(kPlanarRows);
  return z;
}

void StereoPoint::linearize(const GaussianState& state, BlockId pose, BlockId landmark,
                            const Feature& feature, LinearizedMeasurement& out) const {
  check(state, pose, feature);
  const StereoCamera& camera = camera_of(feature);
  const Eigen::Isometry3d T_world_robot = robot_pose(state, pose);
  const Eigen::Isometry3d T_world_camera = T_world_robot * camera.T_robot_camera;
  const Eigen::Vector3d m = place_of(state, landmark, T_world_camera);
  const Eigen::Vector3d p_camera = T_world_camera.inverse() * m;
  Eigen::Vector3d innovation = feature.z - project(camera, p_camera);
  if (!visible(p_camera)) innovation.setConstant(std::numeric_limits<double>::quiet_NaN());
  const Eigen::Matrix3d H =
      projection_jacobian(camera, p_camera) * T_world_camera.linear().transpose();
  const auto H_pose = (-H * point_by_pose(state, pose, m - T_world_robot.translation())).eval();
  out.wrt.clear();
  BlockMatrix& by_pose = out.wrt.add(pose, dimension_, H_pose.cols());
  BlockMatrix& by_landmark = out.wrt.add(landmark, dimension_, dimension_);
  if (dimension_ == 2) {
    out.innovation = innovation(kPlanarRows);
    out.cov = feature.cov(kPlanarRows, kPlanarRows);
    by_pose = H_pose(kPlanarRows, Eigen::all);
    by_landmark = H(kPlanarRows, Eigen::seqN(0, 2));
    return;
  }
  out.innovation = innovation;
  out.cov = feature.cov;
  by_pose = H_pose;
  by_landmark = H;
}

bool StereoPoint::initializable(const Feature& feature) const {
  return feature.z[2] > 0.0 && feature.z[2] >= kKnownDisparity * std::sqrt(feature.cov(2, 2));
}

void StereoPoint::initialize(const GaussianState& state, BlockId pose, const Feature& feature,
                             Initialization& out) const {
  check(state, pose, feature);
  const StereoCamera& camera = camera_of(feature);
  const Eigen::Isometry3d T_world_robot = robot_pose(state, pose);
  const Eigen::Matrix3d R_world_camera = T_world_robot.linear() * camera.T_robot_camera.linear();
  const Eigen::Vector3d p_camera = triangulate(camera, feature.z);
  const Eigen::Vector3d from_robot = T_world_robot.linear() * (camera.T_robot_camera * p_camera);
  const Eigen::Matrix3d G = R_world_camera * triangulation_jacobian(camera, p_camera, feature.z[2]);
  const Eigen::Matrix3d noise = G * feature.cov * G.transpose();
  out.estimate = (T_world_robot.translation() + from_robot).head(dimension_);
  out.wrt.clear();
  out.wrt.add(pose, dimension_, state.size(pose)) =
      point_by_pose(state, pose, from_robot).topRows(dimension_);
  out.cov_noise = noise.topLeftCorner(dimension_, dimension_);
}

}  // namespace libslam
