#pragma once
// A finished run directory, read back.

#include <filesystem>
#include <optional>

#include <libslam/map/landmark_map.hpp>
#include <libslam/result/run_summary.hpp>
#include <libslam/result/trajectory.hpp>
#include <libslam/result/truth_comparison.hpp>

namespace libslam {

struct RecordedRun {
  RunSummary summary;
  EstimatedPath path;
  LandmarkMap map;
};

/// Reads run.json, trajectory.csv and map.csv. Throws std::runtime_error naming the file that
/// cannot be read.
RecordedRun read_recorded_run(const std::filesystem::path& directory);

/// Compares with this truth, as the recorder of the run would have done; only over `window` and
/// with another placement than the run's where they are given.
TruthComparison compare_with_truth(const RecordedRun& run, const GroundTruth& truth,
                                   LandmarkIdentity identity, const RunWindow& window = {},
                                   std::optional<Placement> placement = std::nullopt);

}  // namespace libslam
