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

/// Path figures of a part of the run in `directory`.
inline PathErrors errors_of_steps(const std::filesystem::path& directory, std::int64_t first,
                                  std::int64_t last) {
  RunWindow window;
  window.first_step = first;
  window.last_step = last;
  const GroundTruth truth = read_truth(find_truth(directory.string() + ".rawlog"));
  return *compare_with_truth(read_recorded_run(directory), truth, LandmarkIdentity::known, window)
              .path;
}

inline double degrees(double radians) {
  return radians * 180.0 / kPi;
}

}  // namespace libslam::test
