#pragma once
// Writes the run directory.

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <libslam/data/ground_truth.hpp>
#include <libslam/data/step_record.hpp>
#include <libslam/map/landmark_map.hpp>
#include <libslam/result/report_picture.hpp>
#include <libslam/result/run_summary.hpp>
#include <libslam/result/step_statistics.hpp>

namespace libslam {

struct RecorderOptions {
  std::filesystem::path directory;
  bool force = false;  ///< take an existing directory and replace the files of a run in it
  double trajectory_period_s = 0.0;  ///< shortest time between rows without an update [s]
  bool report = true;                ///< write report.html
  bool events = false;               ///< steps may hold events: write a column for them
};

/// Streams the steps of a run to disk and closes it with map, summary and report.
///
/// What is safe when: each row of trajectory.csv and trajectory.tum is handed to the operating
/// system before record() returns, so a killed or crashed process loses none; a power failure may
/// lose the last seconds. All other files appear complete or not at all. Memory does not grow with
/// the log while recording; finish() holds the path once (128 bytes per row, in space 500) to
/// compare it with truth and to draw it.
class Recorder {
 public:
  /// Creates the directory. Throws std::runtime_error naming the path where it exists and is not an
  /// empty directory (without `force`), or cannot be written.
  explicit Recorder(RecorderOptions options);

  /// Appends a step. Throws std::runtime_error naming the file where writing fails,
  /// std::invalid_argument where a number is not finite, the event holds a comma or control
  /// character, or the columns (TrajectoryColumns) are not those of the first step.
  void record(const StepRecord& step);

  /// The path as it is known at the end: writes trajectory_smoothed.tum; finish() compares it with
  /// the truth, too. Throws std::runtime_error naming the file that cannot be written.
  void add_smoothed_path(Trajectory path);

  /// A picture for the report. Throws std::invalid_argument where `png` is no PNG.
  void add_picture(ReportPicture picture);

  /// Writes map.csv, run.json and report.html, in this order. `summary` holds what the caller
  /// knows; final pose, landmark count, calibration, adapted noise, step times, health of the
  /// innovations, events and the comparison with `truth` under result.placement are filled in here
  /// where it leaves them empty. `identity` says whether the ids of `map` are those of the log.
  /// Returns the completed summary. Throws std::runtime_error naming the file that cannot be
  /// written.
  RunSummary finish(RunSummary summary, const LandmarkMap& map, const GroundTruth& truth,
                    LandmarkIdentity identity);

  const std::filesystem::path& directory() const { return options_.directory; }
  const StepStatistics& statistics() const { return statistics_; }

 private:
  void write_row(const StepRecord& step);
  void check_columns(const StepRecord& step) const;
  void fill_result(RunSummary& summary, const LandmarkMap& map) const;

  RecorderOptions options_;
  std::ofstream csv_, tum_;
  std::string text_;
  bool has_header_ = false;
  bool is_spatial_ = false;
  std::size_t calibration_count_ = 0, noise_count_ = 0;
  double last_row_time_ = 0.0;
  bool last_is_written_ = true;
  std::optional<StepRecord> last_;
  StepStatistics statistics_;
  std::vector<ReportPicture> pictures_;
  std::optional<Trajectory> smoothed_;
};

}  // namespace libslam
