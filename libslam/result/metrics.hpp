#pragma once
// How far a run is from the truth, and whether its covariance says so.

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <mrpt/math/TPose2D.h>

#include <libslam/data/ground_truth.hpp>
#include <libslam/data/step_record.hpp>
#include <libslam/map/landmark_map.hpp>
#include <libslam/result/alignment.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam {

struct PositionErrors {
  double rmse_m = 0, mean_m = 0, max_m = 0, rmse_x_m = 0, rmse_y_m = 0;
};

struct HeadingErrors {
  double rmse_rad = 0, max_rad = 0;
};

/// Absolute errors of a path, [m] and [rad].
///
/// Raw: the path is placed once so that the first matched pose lies on the true one. Aligned: rigid
/// least squares over all matched positions, no scale. A raw placement needs a true heading; with
/// positions only the raw figures are absent.
struct PathErrors {
  using Position = PositionErrors;
  using Heading = HeadingErrors;
  int poses = 0;  ///< matched poses
  std::optional<Position> raw, aligned;
  std::optional<Heading> heading;  ///< of the raw placement
};

/// Relative errors over stretches of `distance_m` of the true path: the error of the relative pose
/// divided by the distance, averaged over all stretches (one from every matched pose). Geiger et
/// al., CVPR 2012.
struct RelativeErrors {
  double distance_m = 0;
  int stretches = 0;
  double trans_percent = 0, rot_deg_per_m = 0;
};

/// Normalized estimation error squared of the pose, 3 degrees of freedom: ideal mean 3. The error
/// is taken in the filter's own coordinates, to which the raw placement carries the truth.
struct NeesSummary {
  int steps = 0;  ///< matched steps with a regular covariance
  double mean = 0, median = 0;
  double in_95 = 0;  ///< fraction between the 2.5 % and the 97.5 % quantile
  std::array<std::optional<double>, 4>
      quarter_mean;        ///< by quarter of the matched part of the run (RunAxis)
  double coverage_95 = 0;  ///< fraction whose 95 % ellipsoid holds the truth, ideal .95
};

/// Position errors of point landmarks [m]; raw under the placement of the path, aligned by their
/// own fit.
struct MapErrors {
  int matched = 0;
  int missed = 0;      ///< true landmarks without an estimate
  int duplicates = 0;  ///< estimates without a true landmark
  std::optional<double> rmse_m, rmse_aligned_m;
};

/// Everything that truth tells about a run; what the truth does not cover is absent.
struct TruthComparison {
  std::optional<PathErrors> path;
  std::optional<RelativeErrors> relative;
  std::optional<NeesSummary> nees;
  std::optional<MapErrors> map;
  std::map<std::string, double> calibration_error;  ///< estimate - truth
  /// T_truth_filter used for raw figures, else the fit of the path; absent without a path.
  std::optional<mrpt::math::TPose2D> placement;
};

/// Who a landmark is: the identity of the log, or only its place.
enum class LandmarkIdentity { known, unknown };

PathErrors compare_path(std::span<const EstimatedPose> estimate, const Trajectory& truth,
                        std::span<const PoseMatch> matches);

/// Nothing where the truth has no heading or the path is shorter than the distance. `distance_m` 0
/// stands for a tenth of the true path, rounded down to 1, 2 or 5 times a power of ten.
std::optional<RelativeErrors> compare_relative(std::span<const EstimatedPose> estimate,
                                               const Trajectory& truth,
                                               std::span<const PoseMatch> matches,
                                               double distance_m = 0.0);

/// NEES of every match; NaN where the covariance is singular (a known start pose, its first
/// motion). Needs a true heading; throws std::invalid_argument without.
std::vector<double> pose_nees(std::span<const EstimatedPose> estimate, const Trajectory& truth,
                              std::span<const PoseMatch> matches);

/// Nothing where no value is finite. `values` belong to `matches`.
std::optional<NeesSummary> summarize_nees(std::span<const EstimatedPose> estimate,
                                          std::span<const PoseMatch> matches,
                                          std::span<const double> values);

/// Compares the x and y of point landmarks. Identities known: by id. Unknown: mutual nearest
/// neighbours after `placement` (T_truth_filter), nothing without a placement. `raw` says whether
/// the placement is the raw one; otherwise only the aligned figure is given.
std::optional<MapErrors> compare_map(const LandmarkMap& map, const std::vector<TrueLandmark>& truth,
                                     LandmarkIdentity identity,
                                     const std::optional<mrpt::math::TPose2D>& placement, bool raw);

/// Parameter name -> estimate.
std::map<std::string, double> calibration_means(const std::vector<CalibrationValue>& calibration);

/// All comparisons that the truth allows. `calibration` holds the final estimates.
TruthComparison compare_with_truth(std::span<const EstimatedPose> estimate, const LandmarkMap& map,
                                   const std::map<std::string, double>& calibration,
                                   const GroundTruth& truth, LandmarkIdentity identity);

}  // namespace libslam
