#pragma once
// CARMEN logs (Radish repository, Freiburg SLAM benchmark): odometry and raw laser scans.

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace libslam {

struct CarmenOptions {
  /// kScans: the odometry pose that the logger attached to every scan. kMessages: the ODOM
  /// messages, so that the pose at a scan is interpolated between them.
  enum class Odometry { kScans, kMessages };
  Odometry odometry = Odometry::kScans;
  double max_range = 80.0;  ///< a range at least as long is no return [m]
  /// Relations of the Freiburg SLAM benchmark; empty: those beside the log, if any.
  std::string relations;
  /// The log as a mapper corrected it (FLASER with corrected poses, of some of the scans); empty:
  /// none.
  std::string reference;
};

struct CarmenSummary {
  bool complete = true;  ///< false: interrupted
  std::int64_t scans = 0, odometry = 0;
  std::int64_t mended_times = 0;                 ///< late stamps among them
  std::map<std::string, std::int64_t> left_out;  ///< by kind of message
  std::int64_t relations = 0, reference_poses = 0;
};

/// Reads `log` (.clf, compressed or not) and writes `rawlog` (X.rawlog): per message one
/// CObservationOdometry ("odometry") and one CObservation2DRangeScan ("laser") with its ipc time
/// stamp. Entries keep the order of the log; late stamps are mended (mended_clock.hpp) and noted in
/// X.truth.json ("mended_times"), so that relations with times of the source still find their
/// scans. Also X.relations (a copy), X.truth.tum (the poses of the reference: those of a mapper on
/// the same scans, no ground truth, as X.truth.json says). Scans of the reference
/// are recognised by their ranges, because its times are printed to six digits only.
///
/// Memory is bounded by the window of the clock, whatever the file. `interrupted` is asked for
/// every message; true ends the rawlog there. Throws InputError where a row cannot be read, the
/// clock goes back too far, the laser moves on the robot, or a scan of the reference is not in the
/// log; nothing is left behind then. Throws std::runtime_error where a file cannot be written.
CarmenSummary import_carmen(const std::string& log, const std::string& rawlog,
                            const CarmenOptions& options,
                            const std::function<bool()>& interrupted = {});

}  // namespace libslam
