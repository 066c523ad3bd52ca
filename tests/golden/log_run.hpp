#pragma once
// A shipped configuration on a log, in a scratch directory.

#include <filesystem>
#include <string>
#include <tests/support/temporary_directory.hpp>
#include <tests/unit/io/data_directory.hpp>
#include <vector>

#include <gtest/gtest.h>

#include <libslam/config/validation.hpp>
#include <libslam/config/yaml_loader.hpp>
#include <libslam/io/importers/imported_log.hpp>
#include <libslam/io/truth_reader.hpp>
#include <libslam/map/landmark_map.hpp>
#include <libslam/pipeline/run.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam::test {

struct LogRun {
  RunSummary summary;
  std::vector<EstimatedPose> path;
  LandmarkMap map;

  const CalibrationValue& calibration(const std::string& name) const {
    for (const auto& value : summary.result.calibration)
      if (value.name == name) return value;
    throw std::out_of_range("no calibration parameter " + name);
  }
};

/// Runs `config` (a file of config/) with `settings` ("section.key=value") on `rawlog`; `save_map`:
/// see RunRequest.
inline LogRun run_log(const std::string& config, const std::string& rawlog,
                      const std::filesystem::path& directory,
                      const std::vector<std::string>& settings = {},
                      const std::filesystem::path& save_map = {}) {
  RunRequest request;
  request.rawlog = rawlog;
  request.parameters = load_yaml(std::filesystem::path(LIBSLAM_CONFIG_DIR) / config);
  request.parameters.output.report = false;
  for (const auto& setting : settings) set_parameter(request.parameters, setting);
  validate(request.parameters);
  request.truth = read_truth(find_truth(rawlog));
  request.directory = directory;
  request.save_map = save_map;
  request.force = true;
  LogRun run;
  run.summary = run_rawlog(request);
  run.path = read_estimated_path(directory / "trajectory.csv");
  run.map = read_landmark_map(directory / "map.csv");
  return run;
}

/// Writes `log` beside `directory` and runs it.
inline LogRun run_imported(const std::string& config, const ImportedLog& log,
                           const std::filesystem::path& directory,
                           const std::vector<std::string>& settings = {},
                           const std::filesystem::path& save_map = {}) {
  const std::string rawlog = directory.string() + ".rawlog";
  write_imported_log(log, rawlog);
  return run_log(config, rawlog, directory, settings, save_map);
}

/// Largest and root mean square distance between two paths at equal times [m].
struct PathDifference {
  double max = 0.0, rms = 0.0;
  int poses = 0;
};

inline PathDifference compare_paths(const LogRun& a, const LogRun& b) {
  PathDifference difference;
  double sum = 0.0;
  std::size_t k = 0;
  for (const auto& pose : a.path) {
    while (k < b.path.size() && b.path[k].time < pose.time - 1e-4) ++k;
    if (k == b.path.size()) break;
    if (b.path[k].time > pose.time + 1e-4) continue;
    const double distance = (b.path[k].pose - pose.pose).head<2>().norm();
    difference.max = std::max(difference.max, distance);
    sum += distance * distance;
    ++difference.poses;
  }
  if (difference.poses > 0) difference.rms = std::sqrt(sum / difference.poses);
  return difference;
}

/// Skips the test with a sentence where a data set is not there.
#define LIBSLAM_REQUIRE_DATA(variable, name)                    \
  const std::string variable = ::libslam::test::data_set(name); \
  if (variable.empty()) GTEST_SKIP() << "data set " << (name) << " is not in $LIBSLAM_DATA"

}  // namespace libslam::test
