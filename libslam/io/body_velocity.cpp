#include <array>

#include <Eigen/Dense>  // before any use of asEigen()

#include <libslam/io/body_velocity.hpp>

namespace libslam {

std::optional<Eigen::Matrix<double, 6, 1>> body_velocity(const mrpt::obs::CObservationIMU& imu) {
  using namespace mrpt::obs;
  constexpr std::array kFields = {IMU_X_VEL, IMU_Y_VEL, IMU_Z_VEL, IMU_WX, IMU_WY, IMU_WZ};
  Eigen::Matrix<double, 6, 1> twist;
  for (std::size_t i = 0; i < kFields.size(); ++i) {
    if (!imu.has(kFields[i])) return std::nullopt;
    twist[static_cast<Eigen::Index>(i)] = imu.get(kFields[i]);
  }
  const Eigen::Matrix3d R = imu.sensorPose.getRotationMatrix().asEigen();
  const Eigen::Vector3d t(imu.sensorPose.x(), imu.sensorPose.y(), imu.sensorPose.z());
  const Eigen::Vector3d rate = R * twist.tail<3>();
  twist.head<3>() = R * twist.head<3>() - rate.cross(t);
  twist.tail<3>() = rate;
  return twist;
}

}  // namespace libslam
