#pragma once
// A finished run directory, read back.

#include <filesystem>
#include <vector>

#include <libslam/map/landmark_map.hpp>
#include <libslam/result/metrics.hpp>
#include <libslam/result/run_summary.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam {

struct RecordedRun {
  RunSummary summary;
  std::vector<EstimatedPose> path;
  LandmarkMap map;
};

/// Reads run.json, trajectory.csv and map.csv. Throws std::runtime_error naming the file that
/// cannot be read.
RecordedRun read_recorded_run(const std::filesystem::path& directory);

/// Compares with this truth, as the recorder of the run would have done.
TruthComparison compare_with_truth(const RecordedRun& run, const GroundTruth& truth,
                                   LandmarkIdentity identity);

}  // namespace libslam
