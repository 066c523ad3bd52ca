#pragma once
// A whole run: a rawlog and parameters in, a run directory out.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include <libslam/config/parameters.hpp>
#include <libslam/data/ground_truth.hpp>
#include <libslam/data/step_record.hpp>
#include <libslam/io/playback_pace.hpp>
#include <libslam/result/run_summary.hpp>

namespace libslam {

struct RunRequest {
  std::string program = "libslam";  ///< name in run.json
  std::string rawlog;
  Parameters parameters;  ///< valid (config/validation.hpp)
  GroundTruth truth;      ///< for the evaluation alone
  std::filesystem::path directory;
  std::filesystem::path save_map;  ///< file for the map at the end (io/map_file.hpp); empty: none
  bool force = false;              ///< replace the files of an earlier run
  std::uint64_t seed = 0;
  int threads = 1;
  Pacing pacing;
  const std::atomic<bool>* stop = nullptr;  ///< set: finish the current step, save, exit code 7
  /// Sees every step; `fraction` of the log in [0, 1].
  std::function<void(double fraction, const StepRecord& step)> on_step;
};

/// Runs to the end of the log, to a stop, or until the filter diverges; whatever was computed is in
/// the directory when this returns. The exit code of the contract is in the summary: 0 done, 5 part
/// of the input was unusable, 6 diverged, 7 stopped. Throws InputError if log or map cannot be
/// opened or its input policy is strict and it has a defect, std::invalid_argument if the log lacks
/// a field that the configuration asks for or the map does not fit the configuration,
/// std::runtime_error if the directory or the map cannot be written; what was computed before is
/// saved then, too. A map that is not sound is not saved, and a warning says so.
RunSummary run_rawlog(const RunRequest& request);

}  // namespace libslam
