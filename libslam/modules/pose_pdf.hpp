#pragma once
// The estimated pose in MRPT's own types.

#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/poses/CPose3DQuatPDFGaussian.h>

#include <libslam/data/step_record.hpp>

namespace libslam {

/// T_world_robot as x, y, z [m], yaw, pitch, roll [rad] with its covariance; a planar pose has
/// zeros in z, pitch and roll. Near a pitch of +-90 degrees, where MRPT's angles are singular, the
/// covariance has no meaning; to_quaternion_pdf has no such place.
mrpt::poses::CPose3DPDFGaussian to_pose_pdf(const StepRecord& record);

/// The same as x, y, z [m] and quaternion r, x, y, z.
mrpt::poses::CPose3DQuatPDFGaussian to_quaternion_pdf(const StepRecord& record);

/// The way back; exact where the covariance is that of a Gaussian and the pitch is not +-90
/// degrees.
SpatialEstimate from_pose_pdf(const mrpt::poses::CPose3DPDF& pose);

}  // namespace libslam
