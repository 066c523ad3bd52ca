#pragma once
// One step of a log: what moved the robot since the last step, and what it saw then.

#include <cstdint>
#include <optional>

#include <Eigen/Core>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>

namespace libslam {

/// Velocity of the robot in its own frame, from one reading of a sensor.
struct HeldTwist {
  Eigen::Matrix<double, 6, 1> twist;  ///< vx, vy, vz [m/s], wx, wy, wz [rad/s]
  double hold = 0.0;                  ///< from this reading to the next [s]
};

/// Both rawlog flavours end up in this form. `action` is null before the first motion (leading
/// frame); `frame` is null where only odometry arrived.
struct LogStep {
  std::int64_t index = 0;  ///< running number of the step, from 0
  double time = 0.0;       ///< time of the step [s since 1970]; finite and never decreasing
  double dt = 0.0;         ///< time since the previous motion [s], 0 if unknown
  bool has_motion_covariance =
      false;  ///< the increment of `action` carries a covariance of its own
  mrpt::obs::CActionCollection::Ptr action;
  std::optional<HeldTwist> twist;  ///< over dt, where body velocities drive the log
  mrpt::obs::CSensoryFrame::Ptr frame;
};

}  // namespace libslam
