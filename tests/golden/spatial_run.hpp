#pragma once
// A shipped configuration on a data set in space.

#include <tests/golden/log_run.hpp>

#include <libslam/io/importers/spatial_log.hpp>
#include <libslam/result/recorded_run.hpp>

namespace libslam::test {

/// Writes `log` beside `directory` and runs it.
inline LogRun run_spatial(const std::string& config, const SpatialLog& log,
                          const std::filesystem::path& directory,
                          const std::vector<std::string>& settings = {}) {
  const std::string rawlog = directory.string() + ".rawlog";
  write_spatial_log(log, rawlog);
  return run_log(config, rawlog, directory, settings);
}

/// A part of the run in `directory` against its truth.
inline TruthComparison compare_part(const std::filesystem::path& directory,
                                    const RunWindow& window) {
  const GroundTruth truth = read_truth(find_truth(directory.string() + ".rawlog"));
  return compare_with_truth(read_recorded_run(directory), truth, LandmarkIdentity::known, window);
}

/// Path figures of some steps.
inline PathErrors errors_of_steps(const std::filesystem::path& directory, std::int64_t first,
                                  std::int64_t last) {
  RunWindow window;
  window.first_step = first;
  window.last_step = last;
  return *compare_part(directory, window).path;
}

/// Mean NEES from a time on [s since the first step].
inline double nees_after(const std::filesystem::path& directory, double from_s) {
  RunWindow window;
  window.from_s = from_s;
  return compare_part(directory, window).nees->mean;
}

inline double degrees(double radians) {
  return radians * 180.0 / kPi;
}

}  // namespace libslam::test
