#pragma once
// Simulated steps as the objects that MRPT's filters take.

#include <cstdint>
#include <numbers>
#include <vector>

#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <libslam/data/feature.hpp>
#include <libslam/data/motion_action.hpp>

namespace libslam::testing {

/// The increment with its covariance, zero where there is none.
inline mrpt::obs::CActionCollection::Ptr make_action(const MotionAction& moved, double time) {
  mrpt::obs::CActionRobotMovement2D action;
  // MRPT replaces the pose change of method odometry by one of its own noise model.
  action.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  action.timestamp = mrpt::Clock::fromDouble(time);
  mrpt::math::CMatrixDouble33 cov;
  if (moved.cov_increment) cov.asEigen() = *moved.cov_increment;
  action.poseChange = mrpt::poses::CPosePDFGaussian::Create(
      mrpt::poses::CPose2D(moved.increment[0], moved.increment[1], moved.increment[2]), cov);
  auto actions = mrpt::obs::CActionCollection::Create();
  actions->insert(action);
  return actions;
}

/// One observation of all features, from a sensor that sees all around.
inline mrpt::obs::CSensoryFrame::Ptr make_frame(const std::vector<Feature>& features,
                                                const Eigen::Vector3d& T_robot_sensor,
                                                double time) {
  auto observation = mrpt::obs::CObservationBearingRange::Create();
  observation->timestamp = mrpt::Clock::fromDouble(time);
  observation->setSensorPose(
      mrpt::poses::CPose3D(T_robot_sensor[0], T_robot_sensor[1], 0.0, T_robot_sensor[2], 0.0, 0.0));
  observation->maxSensorDistance = 100.0F;
  observation->fieldOfView_yaw = static_cast<float>(2.0 * std::numbers::pi);
  for (const Feature& feature : features) {
    auto& sighting = observation->sensedData.emplace_back();
    sighting.range = static_cast<float>(feature.z[0]);
    sighting.yaw = static_cast<float>(feature.z[1]);
    sighting.pitch = 0.0F;
    sighting.landmarkID = static_cast<std::int32_t>(feature.id);
  }
  auto frame = mrpt::obs::CSensoryFrame::Create();
  frame->insert(observation);
  return frame;
}

}  // namespace libslam::testing
