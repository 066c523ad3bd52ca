#pragma once
// CObservationIMU -> velocity of the robot.

#include <optional>

#include <Eigen/Core>
#include <mrpt/obs/CObservationIMU.h>

namespace libslam {

/// vx, vy, vz [m/s], wx, wy, wz [rad/s] of the robot in its own frame, of a reading that has
/// IMU_X_VEL, _Y_, _Z_ and IMU_WX, _WY, _WZ; else nothing. All are taken in the axes of the sensor
/// and moved to the robot along the pose of the sensor: v = R v_s - w x t, w = R w_s. (MRPT has no
/// other fields for a linear velocity; an IMU driver may fill them in a navigation frame, which is
/// of no use here.)
std::optional<Eigen::Matrix<double, 6, 1>> body_velocity(const mrpt::obs::CObservationIMU& imu);

}  // namespace libslam
