#pragma once
// run.json: what happened in a run, in one small file.

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <libslam/data/spatial_pose.hpp>
#include <libslam/data/step_record.hpp>
#include <libslam/result/truth_comparison.hpp>

namespace libslam {

/// Wall time of a step [ms].
struct StepTime {
  double mean = 0, p50 = 0, p95 = 0, max = 0;
};

/// One of the things that happened in a step, see StepRecord::event.
struct RunEvent {
  double time = 0.0;      ///< [s], as in the log
  std::int64_t step = 0;  ///< running number of the step
  std::string what;
};

/// The keys of run.json; what is absent here is absent there. SI units, radians, seconds.
struct RunSummary {
  struct Input {
    std::optional<std::string> file;  ///< path of the log as given on the command line
    std::int64_t entries = 0, actions = 0, observations = 0;
    double duration_s = 0.0;
    std::int64_t skipped = 0, repaired = 0;
    std::vector<std::string> warnings;
    std::optional<std::string> map_file, map_sha256;  ///< of the map that the run started in
  };
  struct Result {
    std::optional<Eigen::Vector3d> pose;  ///< last pose: x [m], y [m], phi [rad]
    std::optional<SpatialPose> pose3d;    ///< the same of a run in space, instead of `pose`
    /// `none`: the run localized in a given map, so that its frame is that of the map.
    Placement placement = Placement::first;
    std::int64_t landmarks = 0;
    std::vector<CalibrationValue> calibration;
    std::vector<AdaptedNoise> noise;  ///< at the end of the run
  };
  struct Timing {
    double wall_s = 0.0, cpu_s = 0.0;
    std::int64_t steps = 0;
    std::optional<StepTime> step_ms;
    std::map<std::string, double> phases;  ///< name -> total time [s]
    std::optional<double> peak_rss_mb, realtime_factor;
    /// Of a schedule that the features stretch: updates made, those of the plain schedule, and the
    /// time that the difference would have taken at the mean time of an update [s].
    std::optional<std::int64_t> updates, updates_without_stretch;
    std::optional<double> saved_s;
  };
  struct Health {
    std::optional<double> nis_mean;  ///< NIS per degree of freedom, ideal 1
    std::optional<double> nis_in_95, gated_fraction, min_eigenvalue;
    std::optional<std::int64_t> disturbances, resamplings, injected;
    std::optional<double> ess_min;
    std::map<std::string, double> features;  ///< how well the front-end works (Frontend::figures)
    std::vector<RunEvent> events;            ///< the first ones, see StepStatistics
  };

  std::string program, version, git;
  std::optional<std::string> config_sha256, input_sha256;
  std::optional<std::uint64_t> seed;
  int threads = 1;
  int exit_code = 0;
  std::string status = "done";
  Input input;
  Result result;
  Timing timing;
  Health health;
  std::optional<TruthComparison> truth;
};

/// run.json as text: keys in a fixed order, indented, numbers that read back exactly; a number that
/// is not finite becomes null.
std::string to_json_text(const RunSummary& summary);

/// Reads to_json_text back; unknown keys are ignored, `truth.placement` is not stored. Throws
/// std::runtime_error naming `name` where the text is not JSON or a key has the wrong type.
RunSummary parse_run_summary(const std::string& text, const std::string& name);

/// Throws std::runtime_error naming the file where it cannot be read.
RunSummary read_run_summary(const std::filesystem::path& file);

}  // namespace libslam
