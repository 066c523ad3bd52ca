#pragma once
// How far a filter is from the batch optimum on the same data.

#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include <libslam/batch/batch_optimizer.hpp>
#include <libslam/batch/filter_replay.hpp>
#include <libslam/data/ground_truth.hpp>
#include <libslam/result/truth_comparison.hpp>

namespace libslam {

/// One of the two answers.
struct BatchAnswer {
  std::vector<EstimatedPose> path;  ///< of the batch: without covariances
  LandmarkMap map;  ///< the confirmed landmarks of the filter; batch: no covariances
  std::vector<CalibrationValue> calibration;  ///< sigma NaN where the batch has none
  std::optional<TruthComparison> truth;
};

/// Filter - batch, both in the frame of the start pose.
struct BatchDistance {
  int landmarks = 0;
  std::optional<double> landmarks_rmse_m, landmarks_max_m;
  std::optional<double> landmarks_rmse_aligned_m;  ///< after a rigid fit of the filter's map
  /// Mean over landmarks of d^T P^-1 d / dim(d) with the filter's covariance P: how large the
  /// distance is beside what the filter itself claims to know.
  std::optional<double> landmarks_normalized;
  /// The filter's path is what it said at the time, the batch's knows the whole log.
  double path_rmse_m = 0.0, path_max_m = 0.0, path_rmse_heading_rad = 0.0;
  double end_m = 0.0, end_heading_rad = 0.0;  ///< the last pose, where both know everything
};

/// The filter's path at some steps beside the batch over the log up to each of them.
struct OnLineComparison {
  int poses = 0;
  double distance_rmse_m = 0.0, distance_rmse_heading_rad = 0.0;
  /// Mean of d^T P^-1 d / 3 with the filter's covariance P, over poses where it is regular.
  std::optional<double> distance_normalized;
  std::optional<PathErrors> filter, batch;  ///< against the truth
};

struct BatchComparison {
  BatchAnswer filter, batch;
  BatchDistance distance;
  BatchResult optimization;
  std::optional<OnLineComparison> on_line;
};

/// Compares; with `truth` also both with it.
BatchComparison compare_with_batch(const FilterReplay& replay, const BatchResult& batch,
                                   const GroundTruth& truth, LandmarkIdentity identity);

/// `count` steps spread evenly over the run, the last one among them; `batch` is what
/// optimize_batch gave, `parts` what it got. Takes `count` times the time of a batch at most.
OnLineComparison compare_on_line(const FilterReplay& replay, const EkfSlamParts& parts,
                                 const BatchResult& batch, const GroundTruth& truth, int count);

/// The content of batch.json: filter, batch {calibration, truth with the keys of run.json},
/// distance, optimization, on_line {filter and batch with the keys of run.json, distances}.
nlohmann::ordered_json to_json(const BatchComparison& comparison);

}  // namespace libslam
