#pragma once
// Rawlogs made for a test, object by object.

#include <filesystem>
#include <string>
#include <vector>

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <libslam/data/log_step.hpp>
#include <libslam/io/rawlog_player.hpp>

namespace libslam::test {

/// Stamp of a time; `kNoTime` gives MRPT's invalid stamp.
inline constexpr double kNoTime = -1.0;
inline mrpt::system::TTimeStamp stamp(double time) {
  return time == kNoTime ? INVALID_TIMESTAMP : mrpt::Clock::fromDouble(time);
}

inline mrpt::obs::CObservationOdometry odometry(double time, double x, double y, double phi) {
  mrpt::obs::CObservationOdometry o;
  o.timestamp = stamp(time);
  o.sensorLabel = "wheels";
  o.odometry = {x, y, phi};
  return o;
}

inline mrpt::obs::CObservationBearingRange sighting(double time, int id = 1, float range = 2.0F) {
  mrpt::obs::CObservationBearingRange o;
  o.timestamp = stamp(time);
  o.sensorLabel = "laser";
  o.sensedData.resize(1);
  o.sensedData[0].range = range;
  o.sensedData[0].yaw = 0.25F;
  o.sensedData[0].pitch = 0.0F;
  o.sensedData[0].landmarkID = id;
  return o;
}

inline mrpt::obs::CSensoryFrame frame(double time) {
  mrpt::obs::CSensoryFrame f;
  f.insert(std::make_shared<mrpt::obs::CObservationBearingRange>(sighting(time)));
  return f;
}

/// An action whose pose change survives storage as it is (MRPT recomputes that of method odometry).
inline mrpt::obs::CActionCollection action(double time, double dx, double variance = 0.0) {
  mrpt::obs::CActionRobotMovement2D motion;
  motion.timestamp = stamp(time);
  motion.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  mrpt::math::CMatrixDouble33 cov;
  cov(0, 0) = variance;
  motion.poseChange =
      mrpt::poses::CPosePDFGaussian::Create(mrpt::poses::CPose2D(dx, 0.0, 0.0), cov);
  mrpt::obs::CActionCollection actions;
  actions.insert(motion);
  return actions;
}

/// Writes objects to `file`, compressed or not.
template <typename... Objects>
std::string write_log(const std::filesystem::path& file, bool compressed,
                      const Objects&... objects) {
  const auto store = [&](auto stream) {
    auto archive = mrpt::serialization::archiveFrom(*stream);
    (void)(archive << ... << objects);
  };
  if (compressed)
    store(std::make_unique<mrpt::io::CFileGZOutputStream>(file.string()));
  else
    store(std::make_unique<mrpt::io::CFileOutputStream>(file.string()));
  return file.string();
}

inline std::vector<LogStep> play(RawlogPlayer& player) {
  std::vector<LogStep> steps;
  while (auto step = player.next()) steps.push_back(std::move(*step));
  return steps;
}

inline PlayerOptions with_policy(const std::string& policy) {
  PlayerOptions options;
  options.input.policy = policy;
  return options;
}

inline mrpt::obs::CActionRobotMovement2D::Ptr motion_of(const LogStep& step) {
  return step.action ? step.action->getActionByClass<mrpt::obs::CActionRobotMovement2D>() : nullptr;
}

}  // namespace libslam::test
