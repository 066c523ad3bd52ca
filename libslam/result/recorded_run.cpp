#include <libslam/result/recorded_run.hpp>

namespace libslam {

RecordedRun read_recorded_run(const std::filesystem::path& directory) {
  return {read_run_summary(directory / "run.json"),
          read_estimated_path(directory / "trajectory.csv"),
          read_landmark_map(directory / "map.csv")};
}

TruthComparison compare_with_truth(const RecordedRun& run, const GroundTruth& truth,
                                   LandmarkIdentity identity) {
  return compare_with_truth(run.path, run.map, calibration_means(run.summary.result.calibration),
                            truth, identity);
}

}  // namespace libslam
