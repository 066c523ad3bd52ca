#pragma once
// What one filter made of one simulated log.

#include <array>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace libslam {

/// Squared errors of a run, summed over its updates: what a pooled RMSE needs.
struct ErrorSums {
  double x = 0.0, y = 0.0, heading = 0.0;  ///< [m^2], [m^2], [rad^2]
  int count = 0;
};

/// Errors and standard deviations of (x, y, phi) at every update of one run.
struct ErrorSeries {
  std::vector<double> times;  ///< since the start [s]
  std::array<std::vector<double>, 3> errors, sigmas;
};

struct VariantOutcome {
  std::string status;  ///< "done", "diverged", or "failed: why"
  /// `truth`, `health`, `timing` as in run.json, `calibration` as its result.calibration, and
  /// `noise`: name -> adapted and configured sigma at the end.
  /// `recovery` (campaign/recovery.hpp) where the robot is kidnapped.
  nlohmann::ordered_json figures;
  ErrorSums sums;
  /// Of the pose at every observation of the log, the same times in all runs of a point; NaN where
  /// the filter made no update, and where P is singular.
  std::vector<double> nees;
  ErrorSeries series;  ///< of the first run of a point alone

  bool done() const { return status == "done"; }
  bool failed() const { return status.starts_with("failed"); }
};

/// All filters on one log, in the order of the variants.
struct RunOutcome {
  bool retried = false;  ///< an earlier attempt had failed
  std::vector<VariantOutcome> variants;
};

/// As bytes, exactly; for the journal and for messages between processes.
std::vector<std::uint8_t> to_bytes(const RunOutcome& outcome);
/// Throws nlohmann::json::exception where the bytes are no outcome.
RunOutcome outcome_from_bytes(const std::vector<std::uint8_t>& bytes);

}  // namespace libslam
