#pragma once
// What is known to be true about a log. It reaches the evaluation, never a filter.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/trajectory.hpp>

namespace libslam {

/// A landmark of a true map.
struct TrueLandmark {
  std::int64_t id = 0;
  Eigen::VectorXd position;  ///< x, y[, z] [m]
};

/// Where a robot was at one time, seen from where it was at another.
struct PoseRelation {
  double from_time = 0.0, to_time = 0.0;                ///< [s]
  Eigen::Vector3d T_from_to = Eigen::Vector3d::Zero();  ///< x [m], y [m], phi [rad]
};

/// True path, map, calibration and relations; each part may be missing (empty).
struct GroundTruth {
  Trajectory path;
  std::vector<TrueLandmark> landmarks;
  std::map<std::string, double> calibration;  ///< parameter name -> true value

  std::vector<PoseRelation> relations;

  bool empty() const {
    return path.poses.empty() && landmarks.empty() && calibration.empty() && relations.empty();
  }
};

}  // namespace libslam
