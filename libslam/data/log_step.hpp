#pragma once
// One step of a log: what moved the robot since the last step, and what it saw then.

#include <cstdint>

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>

namespace libslam {

/// Both rawlog flavours end up in this form. `action` is null before the first motion (leading
/// frame); `frame` is null where only odometry arrived.
struct LogStep {
  std::int64_t index = 0;  ///< running number of the step, from 0
  double time = 0.0;       ///< time of the step [s since 1970]; finite and never decreasing
  double dt = 0.0;         ///< time since the previous motion [s], 0 if unknown
  bool has_motion_covariance =
      false;  ///< the increment of `action` carries a covariance of its own
  mrpt::obs::CActionCollection::Ptr action;
  mrpt::obs::CSensoryFrame::Ptr frame;
};

}  // namespace libslam
