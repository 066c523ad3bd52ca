#pragma once
// Everything that truth tells about a run.

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <mrpt/math/TPose2D.h>

#include <libslam/data/ground_truth.hpp>
#include <libslam/data/step_record.hpp>
#include <libslam/map/landmark_map.hpp>
#include <libslam/result/metrics.hpp>
#include <libslam/result/relations.hpp>

namespace libslam {

/// What the truth does not cover is absent.
struct TruthComparison {
  std::optional<PathErrors> path;
  std::optional<RelativeErrors> relative;
  std::optional<NeesSummary> nees;
  std::optional<MapErrors> map;
  std::optional<RelationErrors> relations;  ///< of the path as it was driven
  /// Of the path as it was known at the end, in the plane; placed by its own first match or fit.
  std::optional<PathErrors> path_smoothed;
  std::optional<RelationErrors> relations_smoothed;
  std::map<std::string, double> calibration_error;  ///< estimate - truth
  /// T_truth_filter used for raw figures, else the fit of the path; absent without a path. One of
  /// the two: of a comparison in the plane, or in space.
  std::optional<mrpt::math::TPose2D> placement;
  std::optional<Eigen::Isometry3d> spatial_placement;
};

/// How raw figures bring a run into the frame of the truth.
enum class Placement {
  first,  ///< the first matched pose of the run on the true one
  none    ///< not at all: a run in a known map is in its frame
};

/// A part of a run, ends included: numbers of steps, and time since its first step [s].
struct RunWindow {
  std::int64_t first_step = std::numeric_limits<std::int64_t>::min();
  std::int64_t last_step = std::numeric_limits<std::int64_t>::max();
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
};

struct ComparisonRules {
  Placement placement = Placement::first;
  /// Path figures are those of this part; the run is placed by its whole path nevertheless.
  RunWindow window{};
};

/// Parameter name -> estimate.
std::map<std::string, double> calibration_means(const std::vector<CalibrationValue>& calibration);

/// All comparisons that the truth allows. `calibration` holds the final estimates. A run in space
/// is compared in space, with a planar truth at height 0; with planar positions only, its shadow is
/// compared in the plane.
TruthComparison compare_with_truth(const PathView& estimate, const LandmarkMap& map,
                                   const std::map<std::string, double>& calibration,
                                   const GroundTruth& truth, LandmarkIdentity identity,
                                   const ComparisonRules& rules = {});

/// Adds what the truth says of `smoothed`, a path with times in the plane: the path of a run as it
/// was known at its end. `estimate`, the path as it was driven, tells which step was when.
void compare_smoothed(const Trajectory& smoothed, std::span<const EstimatedPose> estimate,
                      const GroundTruth& truth, const ComparisonRules& rules,
                      TruthComparison& comparison);

/// The truth as `estimate` is compared with it: in space where that comparison is, in the plane
/// elsewhere.
Trajectory comparable_truth(const PathView& estimate, const Trajectory& truth);

}  // namespace libslam
