#pragma once
// The velocity of a vehicle as its sensors say it one after another; not for users.

#include <Eigen/Core>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

namespace libslam {

/// Velocity and turn rate in the frame of the vehicle, each as last read.
class VehicleTwist {
 public:
  /// Takes what `imu` has of turn rates, and of a velocity with the orientation to express it.
  void read(const mrpt::obs::CObservationIMU& imu);
  /// Takes the velocity, if there is one, and the turn rate while there is no IMU.
  void read(const mrpt::obs::CObservationOdometry& odometry);

  bool known() const { return known_; }
  /// A movement with this twist that ends at `time`.
  mrpt::obs::CActionCollection::Ptr action(mrpt::Clock::time_point time) const;

 private:
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  // [m/s]
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();      // [rad/s]
  bool known_ = false, has_gyro_ = false;
};

}  // namespace libslam
