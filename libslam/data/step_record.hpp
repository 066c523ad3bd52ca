#pragma once
// What one step of a run leaves behind for the recorder.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/extent.hpp>
#include <libslam/data/spatial_pose.hpp>

namespace libslam {

/// A calibration parameter that is a block of the state.
struct CalibrationValue {
  std::string name;    ///< e.g. "scale_left"
  double mean = 0.0;   ///< in the unit of the parameter
  double sigma = 0.0;  ///< standard deviation of `mean`
  double prior_mean = 0.0;
  double prior_sigma = 0.0;
  bool observable = false;  ///< the data excited it and sigma fell below half of its prior
};

/// A noise that a policy adapts while the run goes.
struct AdaptedNoise {
  std::string name;         ///< sensor channel and component, e.g. "range"
  double sigma = 0.0;       ///< adapted standard deviation, in the unit of the component
  double configured = 0.0;  ///< what the run started from
  std::string unit = {};    ///< of both; empty: a ratio
};

/// A landmark of the estimated map.
struct LandmarkEstimate {
  std::int64_t id = 0;         ///< identity from the log, else a running number
  std::string type = "point";  ///< kind of landmark
  Eigen::VectorXd mean;        ///< world coordinates
  Eigen::MatrixXd cov;         ///< covariance of `mean`
  int times_seen = 0;
  std::optional<Extent> extent = std::nullopt;  ///< of a line, all that was seen of it
};

/// One row of trajectory.csv. Covariances are in (x [m], y [m], phi [rad]) of the world frame.
struct StepRecord {
  std::int64_t index = 0;  ///< running number of the step
  double time = 0.0;       ///< [s], as in the log
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();
  std::optional<SpatialEstimate> spatial;  ///< of a run in space; pose and cov are its shadow then
  double nis = 0.0;  ///< normalized innovation squared of the joint update, 0 without update
  int nis_dof = 0;   ///< degrees of freedom of `nis`
  int accepted = 0, gated = 0, ambiguous = 0, new_landmarks = 0;
  std::vector<CalibrationValue> calibration;
  std::vector<AdaptedNoise> noise;  ///< the same names in every step of a run
  /// E.g. "disturbance", "lost", "disturbance+relocalized" (data/step_events.hpp); empty where
  /// nothing happened.
  std::string event;
  double step_ms = 0.0;  ///< wall time of the step; never written to trajectory.csv
};

}  // namespace libslam
