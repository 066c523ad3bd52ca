#pragma once
// A whole simulated drive: a scenario in, a log and its truth out.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>

#include <libslam/simulation/scenario.hpp>

namespace libslam {

struct DriveRequest {
  Scenario scenario;  ///< valid (pipeline/simulation.hpp); its seed is the seed of the drive
  std::filesystem::path rawlog;             ///< X.rawlog
  const std::atomic<bool>* stop = nullptr;  ///< set: finish the current step, save, exit code 7
  std::function<void(double fraction)> on_step;  ///< part of the way, in [0, 1]
};

struct DriveSummary {
  int exit_code = 0;  ///< 0 done, 7 stopped
  std::int64_t steps = 0, observations = 0;
  double duration_s = 0.0, distance_m = 0.0;  ///< of the true path
};

/// Writes the files of SimulatedLogWriter, and X.scenario.yaml: the complete effective scenario,
/// which gives the same bytes again, and X.filter.yaml (nominal_filter) for slam-run. A world that
/// came from files goes with it (X.way_points.csv, X.walls.csv), so that the files can be moved
/// together.
///
/// Throws InputError where a file of the world cannot be used, std::runtime_error where a file
/// cannot be written, or the way cannot be driven; what was driven so far is saved then, too.
DriveSummary simulate_drive(const DriveRequest& request);

}  // namespace libslam
