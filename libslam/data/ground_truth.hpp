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

/// True path, map and calibration; each part may be missing (empty).
struct GroundTruth {
  Trajectory path;
  std::vector<TrueLandmark> landmarks;
  std::map<std::string, double> calibration;  ///< parameter name -> true value

  bool empty() const { return path.poses.empty() && landmarks.empty() && calibration.empty(); }
};

}  // namespace libslam
