#include <libslam/result/recorded_run.hpp>

namespace libslam {

RecordedRun read_recorded_run(const std::filesystem::path& directory) {
  return {read_run_summary(directory / "run.json"), read_path(directory / "trajectory.csv"),
          read_landmark_map(directory / "map.csv")};
}

TruthComparison compare_with_truth(const RecordedRun& run, const GroundTruth& truth,
                                   LandmarkIdentity identity, const RunWindow& window,
                                   std::optional<Placement> placement) {
  const RunSummary::Result& result = run.summary.result;
  return compare_with_truth(run.path, run.map, calibration_means(result.calibration), truth,
                            identity, {placement.value_or(result.placement), window});
}

}  // namespace libslam
