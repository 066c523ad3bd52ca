#pragma once
// The best possible answer: nonlinear least squares over all poses and landmarks of a log (Ceres).

#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Core>

#include <libslam/io/importers/imported_log.hpp>

namespace libslam::test {

struct BatchEstimate {
  std::vector<Eigen::Vector3d> poses;  ///< x [m], y [m], phi [rad]; one per odometry row
  std::map<std::int64_t, Eigen::Vector2d> landmarks;  ///< [m]
  double initial_cost = 0.0, final_cost = 0.0;  ///< half the sum of squared whitened residuals
  bool converged = false;
};

/// Minimizes the whitened residuals of all increments (body frame, covariance of the log) and all
/// range-bearing sightings from `start`; the first pose is fixed. `log` has covariances throughout,
/// its scans stand at times of odometry rows.
BatchEstimate optimize(const ImportedLog& log, BatchEstimate start);

}  // namespace libslam::test
