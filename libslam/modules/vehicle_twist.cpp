#include <initializer_list>
#include <optional>

#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/obs/CActionRobotMovement3D.h>

#include <libslam/modules/vehicle_twist.hpp>

namespace libslam {

namespace {

using mrpt::obs::CObservationIMU;
using mrpt::obs::TIMUDataIndex;

bool has_all(const CObservationIMU& imu, std::initializer_list<TIMUDataIndex> fields) {
  for (const TIMUDataIndex field : fields)
    if (!imu.has(field)) return false;
  return true;
}

/// R_navigation_vehicle, if the IMU knows it.
std::optional<Eigen::Matrix3d> orientation_of(const CObservationIMU& imu) {
  using namespace mrpt::obs;  // the names of the fields
  if (has_all(imu, {IMU_ORI_QUAT_W, IMU_ORI_QUAT_X, IMU_ORI_QUAT_Y, IMU_ORI_QUAT_Z}))
    return Eigen::Quaterniond(imu.get(IMU_ORI_QUAT_W), imu.get(IMU_ORI_QUAT_X),
                              imu.get(IMU_ORI_QUAT_Y), imu.get(IMU_ORI_QUAT_Z))
        .normalized()
        .toRotationMatrix();
  if (!has_all(imu, {IMU_YAW, IMU_PITCH, IMU_ROLL})) return std::nullopt;
  return (Eigen::AngleAxisd(imu.get(IMU_YAW), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(imu.get(IMU_PITCH), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(imu.get(IMU_ROLL), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace

void VehicleTwist::read(const CObservationIMU& imu) {
  using namespace mrpt::obs;  // the names of the fields
  if (has_all(imu, {IMU_WX, IMU_WY, IMU_WZ})) {
    rate_ = {imu.get(IMU_WX), imu.get(IMU_WY), imu.get(IMU_WZ)};
    known_ = has_gyro_ = true;
  }
  const std::optional<Eigen::Matrix3d> R_navigation_vehicle = orientation_of(imu);
  if (R_navigation_vehicle && has_all(imu, {IMU_X_VEL, IMU_Y_VEL, IMU_Z_VEL})) {
    const Eigen::Vector3d in_navigation(imu.get(IMU_X_VEL), imu.get(IMU_Y_VEL), imu.get(IMU_Z_VEL));
    velocity_ = R_navigation_vehicle->transpose() * in_navigation;
    known_ = true;
  }
}

void VehicleTwist::read(const mrpt::obs::CObservationOdometry& odometry) {
  if (!odometry.hasVelocities) return;
  velocity_ = {odometry.velocityLocal.vx, odometry.velocityLocal.vy, 0.0};
  if (!has_gyro_) rate_ = {0.0, 0.0, odometry.velocityLocal.omega};
  known_ = true;
}

mrpt::obs::CActionCollection::Ptr VehicleTwist::action(mrpt::Clock::time_point time) const {
  mrpt::obs::CActionRobotMovement3D movement;
  movement.timestamp = time;
  movement.hasVelocities.assign(6, true);
  movement.velocities.resize(6);
  for (int i = 0; i < 3; ++i) {
    movement.velocities[i] = static_cast<float>(velocity_[i]);
    movement.velocities[3 + i] = static_cast<float>(rate_[2 - i]);  // yaw, pitch, roll
  }
  auto actions = mrpt::obs::CActionCollection::Create();
  actions->insert(movement);
  return actions;
}

}  // namespace libslam
