#pragma once
// A drive through a small world, taken down for a batch and for the filter beside it.

#include <limits>
#include <random>
#include <tests/support/slam_world.hpp>
#include <vector>

#include <Eigen/Dense>

#include <libslam/association/known.hpp>
#include <libslam/batch/batch_optimizer.hpp>
#include <libslam/batch/batch_recorder.hpp>
#include <libslam/measurement/range_bearing.hpp>
#include <libslam/motion/differential.hpp>
#include <libslam/motion/odometry_increment.hpp>

namespace libslam::testing {

constexpr double kVirtualTrack = 0.5;   // [m]
constexpr double kSigmaAcross = 0.002;  // [m] per step: makes the process noise regular

inline EkfSlamParts batch_parts(const CalibrationParameters& calibration = {}) {
  EkfSlamParts parts;
  MotionParameters motion;
  motion.track_width = kVirtualTrack;
  if (calibration.scale_left.enabled)
    parts.motion = std::make_unique<Differential>(motion, calibration);
  else
    parts.motion = std::make_unique<OdometryIncrement>(motion, calibration);
  parts.measurement = std::make_unique<RangeBearing>();
  parts.associator = std::make_unique<KnownAssociation>(std::numeric_limits<double>::infinity());
  parts.frame = make_error_frame("right_invariant");
  return parts;
}

struct Drive {
  BatchLog log;
  BatchEstimate filter;
  std::vector<Eigen::Vector3d> truth;           ///< pose after every step
  std::vector<Eigen::Vector2d> true_landmarks;  ///< as log.landmarks
};

/// `steps` steps with a sighting of everything in range at every `every`-th. `noise` scales all
/// noise. `across`: sideways noise as well, in the drive and in its covariance. `change` may alter
/// what the odometry says.
template <typename Change>
Drive drive_world(unsigned seed, int steps, int every, double noise, bool across, EkfSlam& filter,
                  Change change) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  SlamWorld world;
  BatchRecorder recorder(filter);
  Drive drive;
  const std::vector<Feature> first = world.observe(random, noise);
  recorder.on_update(first, filter.update(first));
  recorder.end_step(0, 0.0);
  drive.truth.push_back(world.pose);
  for (int k = 1; k <= steps; ++k) {
    MotionAction action = world.drive(random, noise);
    if (across) {
      action.increment[1] += noise * kSigmaAcross * normal(random);
      (*action.cov_increment)(1, 1) += kSigmaAcross * kSigmaAcross;
    }
    change(action);
    filter.propagate(&action);
    recorder.on_motion(&action);
    if (k % every == 0) {
      const std::vector<Feature> seen = world.observe(random, noise);
      recorder.on_update(seen, filter.update(seen));
    }
    recorder.end_step(k, 0.1 * k);
    drive.truth.push_back(world.pose);
  }
  drive.log = recorder.log();
  drive.filter = recorder.estimate();
  for (const std::int64_t id : drive.log.landmarks)
    drive.true_landmarks.push_back(world.landmarks[static_cast<std::size_t>(id)]);
  return drive;
}

}  // namespace libslam::testing
