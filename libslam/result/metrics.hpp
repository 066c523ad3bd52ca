#pragma once
// How far a run is from the truth, and whether its covariance says so.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <mrpt/math/TPose2D.h>

#include <libslam/data/ground_truth.hpp>
#include <libslam/map/landmark_map.hpp>
#include <libslam/result/alignment.hpp>
#include <libslam/result/stretches.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam {

struct PositionErrors {
  double rmse_m = 0, mean_m = 0, max_m = 0, rmse_x_m = 0, rmse_y_m = 0;
  std::optional<double> rmse_z_m;  ///< in space
};

struct HeadingErrors {
  double rmse_rad = 0, max_rad = 0;
};

/// Angles between true and estimated orientations.
struct RotationErrors {
  double rmse_rad = 0, max_rad = 0;
};

/// Absolute errors of a path, [m] and [rad].
///
/// Raw: the path is placed once so that the first matched pose lies on the true one. Aligned: rigid
/// least squares over all matched positions, no scale. A raw placement needs a true heading; with
/// positions only the raw figures are absent. A path that is in the frame of the truth already is
/// not placed.
struct PathErrors {
  using Position = PositionErrors;
  using Heading = HeadingErrors;
  int poses = 0;  ///< matched poses
  std::optional<Position> raw, aligned;
  std::optional<Heading> heading;            ///< of the raw placement, in the plane
  std::optional<RotationErrors> rotation{};  ///< of the raw placement, in space
  /// Raw position error of the last matched pose over the length of the true path, in space.
  std::optional<double> drift_percent{};
};

/// Normalized estimation error squared of the pose, 3 degrees of freedom in the plane and 6 in
/// space: that many is the ideal mean. The error is taken in the filter's own coordinates, to which
/// the raw placement carries the truth.
struct NeesSummary {
  int steps = 0;  ///< matched steps with a regular covariance
  double mean = 0, median = 0;
  double in_95 = 0;  ///< fraction between the 2.5 % and the 97.5 % quantile
  std::array<std::optional<double>, 4>
      quarter_mean;        ///< by quarter of the matched part of the run (RunAxis)
  double coverage_95 = 0;  ///< fraction whose 95 % ellipsoid holds the truth, ideal .95
  int dof = 3;
};

/// Position errors of point landmarks [m]; raw under the placement of the path, aligned by their
/// own fit.
struct MapErrors {
  int matched = 0;
  int missed = 0;      ///< true landmarks without an estimate
  int duplicates = 0;  ///< estimates without a true landmark
  std::optional<double> rmse_m, rmse_aligned_m;
};

/// Who a landmark is: the identity of the log, or only its place.
enum class LandmarkIdentity { known, unknown };

/// Raw under `T_truth_filter`; without it the first match places the path.
PathErrors compare_path(std::span<const EstimatedPose> estimate, const Trajectory& truth,
                        std::span<const PoseMatch> matches,
                        const std::optional<mrpt::math::TPose2D>& T_truth_filter = std::nullopt);

/// Nothing where the truth has no heading or the path is shorter than the distance. `distance_m`:
/// see average_over_stretches.
std::optional<RelativeErrors> compare_relative(std::span<const EstimatedPose> estimate,
                                               const Trajectory& truth,
                                               std::span<const PoseMatch> matches,
                                               double distance_m = 0.0);

/// NEES of every match; NaN where the covariance is singular (a known start pose, its first
/// motion). Without `T_truth_filter` the first match places the path. Needs a true heading; throws
/// std::invalid_argument without.
std::vector<double> pose_nees(
    std::span<const EstimatedPose> estimate, const Trajectory& truth,
    std::span<const PoseMatch> matches,
    const std::optional<mrpt::math::TPose2D>& T_truth_filter = std::nullopt);

/// Nothing where no value is finite. `values` belong to `matches` and have `dof` degrees of
/// freedom.
std::optional<NeesSummary> summarize_nees(std::span<const EstimatedPose> estimate,
                                          std::span<const PoseMatch> matches,
                                          std::span<const double> values, int dof = 3);

/// Compares the x and y of point landmarks. Identities known: by id. Unknown: mutual nearest
/// neighbours after `placement` (T_truth_filter), nothing without a placement. `raw` says whether
/// the placement is the raw one; otherwise only the aligned figure is given.
std::optional<MapErrors> compare_map(const LandmarkMap& map, const std::vector<TrueLandmark>& truth,
                                     LandmarkIdentity identity,
                                     const std::optional<mrpt::math::TPose2D>& placement, bool raw);

/// The same with x, y and z; a landmark without z is at height 0.
std::optional<MapErrors> compare_map_in_space(const LandmarkMap& map,
                                              const std::vector<TrueLandmark>& truth,
                                              LandmarkIdentity identity,
                                              const std::optional<Eigen::Isometry3d>& placement,
                                              bool raw);

}  // namespace libslam
