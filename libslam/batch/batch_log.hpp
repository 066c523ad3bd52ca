#pragma once
// All data of a run at once, and an estimate of everything in it.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/feature.hpp>
#include <libslam/data/motion_action.hpp>

namespace libslam {

/// A feature that the filter took for a sighting of a landmark, its first one included.
struct BatchSighting {
  std::size_t landmark = 0;  ///< position in BatchLog::landmarks
  Feature feature;
};

/// One step of a log: what moved the robot to it, then what was seen there.
struct BatchStep {
  std::int64_t index = 0;                            ///< number of the step in the log
  double time = 0.0;                                 ///< [s]
  std::vector<std::optional<MotionAction>> motions;  ///< empty ones: a motion without odometry
  std::vector<BatchSighting> sightings;
};

struct BatchLog {
  std::vector<BatchStep> steps;
  std::vector<std::int64_t> landmarks;  ///< identity of every landmark; a landmark has sightings
};

/// Poses are (x [m], y [m], phi [rad]) in the frame of the start pose.
struct BatchEstimate {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> path;       ///< one pose per step
  std::vector<Eigen::VectorXd> landmarks;  ///< as BatchLog::landmarks, world coordinates
  Eigen::VectorXd calibration;             ///< in the order of the motion model, at the last step
};

}  // namespace libslam
