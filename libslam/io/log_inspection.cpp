#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationBearingRange.h>

#include <libslam/io/log_inspection.hpp>
#include <libslam/io/mrpt_fields.hpp>

namespace libslam {
namespace {

using mrpt::obs::CObservation;
using mrpt::obs::CObservationBearingRange;

/// A hostile log must not fill the memory with names and numbers.
constexpr std::size_t kMaxIdentities = 100000, kMaxSensors = 1000;
constexpr double kAgreement = 0.1, kAgreementFloor = 0.01;

bool agrees(double a, double b) {
  return std::abs(a - b) <= kAgreement * std::max(std::abs(a), std::abs(b)) + kAgreementFloor;
}

void count_time(SensorStatistics& sensor, mrpt::system::TTimeStamp stamp) {
  const bool first = sensor.count == sensor.invalid_times;
  ++sensor.count;
  const auto time = stamp_seconds(stamp);
  if (!time) {
    ++sensor.invalid_times;
    return;
  }
  if (first) sensor.first_time = sensor.last_time = *time;
  if (*time < sensor.last_time) ++sensor.backward_times;
  sensor.longest_gap = std::max(sensor.longest_gap, *time - sensor.last_time);
  sensor.first_time = std::min(sensor.first_time, *time);
  sensor.last_time = std::max(sensor.last_time, *time);
}

void count_sightings(LandmarkStatistics& landmarks, const CObservationBearingRange& observation) {
  for (const auto& sighting : observation.sensedData) {
    const double range = sighting.range;
    const bool first = landmarks.sightings == landmarks.unusable;
    ++landmarks.sightings;
    if (!(range > 0.0) || !std::isfinite(range) || !std::isfinite(sighting.yaw)) {
      ++landmarks.unusable;
      continue;
    }
    landmarks.min_range = first ? range : std::min(landmarks.min_range, range);
    landmarks.max_range = std::max(landmarks.max_range, range);
    if (sighting.landmarkID < 0) continue;
    ++landmarks.with_identity;
    if (landmarks.identities.size() < kMaxIdentities)
      landmarks.identities.insert(sighting.landmarkID);
  }
}

/// How far an action moves, in the plane or in space.
struct Motion {
  double distance = 0.0, turn = 0.0;     ///< [m], [rad], not negative
  std::optional<bool> velocities_agree;  ///< with the pose change, where there are any
  bool has_ticks = false;
};

Motion motion_of(const mrpt::obs::CActionRobotMovement2D& action, double dt) {
  mrpt::poses::CPose2D increment;
  action.poseChange->getMean(increment);
  Motion motion{increment.norm(), std::abs(increment.phi()), {}, action.hasEncodersInfo};
  const auto& v = action.velocityLocal;
  if (action.hasVelocities)
    motion.velocities_agree = agrees(std::hypot(v.vx, v.vy) * dt, motion.distance) &&
                              agrees(v.omega * dt, increment.phi());
  return motion;
}

Motion motion_of(const mrpt::obs::CActionRobotMovement3D& action, double dt) {
  const mrpt::poses::CPose3D& increment = action.poseChange.mean;
  const double cosine = 0.5 * (increment.getRotationMatrix().trace() - 1.0);
  Motion motion{increment.norm(), std::acos(std::clamp(cosine, -1.0, 1.0)), {}, false};
  const auto& v = action.velocities;
  if (v.size() == 6 && std::ranges::all_of(action.hasVelocities, std::identity{}))
    motion.velocities_agree = agrees(std::hypot(v[0], v[1], v[2]) * dt, motion.distance) &&
                              agrees(std::hypot(v[3], v[4], v[5]) * dt, motion.turn);
  return motion;
}

/// Nothing for an action that does not move the robot.
std::optional<Motion> motion_of(const mrpt::obs::CActionCollection& action, double dt) {
  if (const auto planar = action.getActionByClass<mrpt::obs::CActionRobotMovement2D>())
    return motion_of(*planar, dt);
  if (const auto spatial = action.getActionByClass<mrpt::obs::CActionRobotMovement3D>())
    return motion_of(*spatial, dt);
  return std::nullopt;
}

}  // namespace

double SensorStatistics::rate() const {
  const double span = last_time - first_time;
  const auto valid = count - invalid_times;
  return valid > 1 && span > 0.0 ? static_cast<double>(valid - 1) / span : 0.0;
}

void LogInspection::observe(const RawlogEntry& entry) {
  ++classes_[entry.class_name];
  if (entry.kind == EntryKind::kObservation) {
    observe(dynamic_cast<const CObservation&>(*entry.object));
  } else if (entry.kind == EntryKind::kFrame) {
    for (const auto& observation : dynamic_cast<const mrpt::obs::CSensoryFrame&>(*entry.object))
      if (observation) observe(*observation);
  }
}

void LogInspection::observe(const CObservation& observation) {
  const std::string name =
      (observation.sensorLabel.empty() ? "(no label)" : observation.sensorLabel) + " (" +
      observation.GetRuntimeClass()->className + ")";
  if (sensors_.size() < kMaxSensors || sensors_.contains(name))
    count_time(sensors_[name], observation.timestamp);
  if (const auto* landmarks = dynamic_cast<const CObservationBearingRange*>(&observation))
    count_sightings(landmarks_, *landmarks);
}

void LogInspection::observe(const LogStep& step) {
  if (steps_++ == 0) first_time_ = step.time;
  last_time_ = step.time;
  if (!step.action) return;
  const auto motion = motion_of(*step.action, step.dt);
  if (!motion) return;
  ++odometry_.motions;
  odometry_.with_covariance += step.has_motion_covariance ? 1 : 0;
  odometry_.with_ticks += motion->has_ticks ? 1 : 0;
  odometry_.path_length += motion->distance;
  odometry_.total_turn += motion->turn;
  odometry_.with_velocities += motion->velocities_agree ? 1 : 0;
  odometry_.velocities_agree += motion->velocities_agree.value_or(false) ? 1 : 0;
  if (step.dt > 0.0) {
    odometry_.max_speed = std::max(odometry_.max_speed, motion->distance / step.dt);
    odometry_.max_turn_rate = std::max(odometry_.max_turn_rate, motion->turn / step.dt);
  }
}

}  // namespace libslam
