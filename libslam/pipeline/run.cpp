#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include <Eigen/Eigenvalues>

#include <libslam/config/digest.hpp>
#include <libslam/config/version.hpp>
#include <libslam/config/yaml_loader.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/map_file.hpp>
#include <libslam/io/rawlog_player.hpp>
#include <libslam/pipeline/frame_picture.hpp>
#include <libslam/pipeline/landmark_identity.hpp>
#include <libslam/pipeline/mrpt_files.hpp>
#include <libslam/pipeline/pipeline.hpp>
#include <libslam/pipeline/process_usage.hpp>
#include <libslam/pipeline/run.hpp>
#include <libslam/policy/noise_warnings.hpp>
#include <libslam/result/atomic_file.hpp>
#include <libslam/result/recorder.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam {

namespace {

using Clock = std::chrono::steady_clock;

/// Beyond this dimension an eigenvalue decomposition would take longer than the run.
constexpr Eigen::Index kLargestSpectrum = 1500;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

PlayerOptions player_options(const RunRequest& request) {
  PlayerOptions options;
  options.input = request.parameters.input;
  options.pacing = request.pacing;
  options.pacing.before_step = [stop = request.stop,
                                inner = request.pacing.before_step](const LogStep& step) {
    return !(stop != nullptr && stop->load()) && (!inner || inner(step));
  };
  return options;
}

/// Found out before the run rather than after it.
void require_folder_of_map(const std::filesystem::path& file) {
  if (file.empty()) return;
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder))
    throw std::runtime_error("cannot write " + file.string() + ": no directory " + folder.string());
}

/// Surveyed landmarks stand in the frame of the truth, and so does a run among them.
Placement placement_in(const MapParameters& map) {
  return map.file.empty() || is_saved_map(map.file) ? Placement::first : Placement::none;
}

class Run {
 public:
  explicit Run(const RunRequest& request)
      : request_(request),
        player_(request.rawlog, player_options(request)),
        pipeline_(request.parameters),
        recorder_({request.directory, request.force, request.parameters.output.trajectory_period_s,
                   request.parameters.output.report,
                   request.parameters.policies.implied_input.enabled ||
                       request.parameters.policies.disturbance.response != "none"}) {
    replace_file(request.directory / "config.yaml", to_yaml(request.parameters));
  }

  /// Processes steps until the end; an exception is kept, so that results are saved first.
  void play() {
    try {
      while (exit_code_ == 0) {
        if (stopped()) return end(7, "interrupted");
        const auto step = player_.next();
        if (!step) return stopped() ? end(7, "interrupted") : void();
        process(*step);
      }
    } catch (const InputError&) {
      fail(4, "input rejected");
    } catch (const std::invalid_argument&) {
      fail(3, "the configuration does not fit the log");
    } catch (...) {
      fail(2, "failed");
    }
  }

  RunSummary finish() {
    save_map();
    const LandmarkMap map = finite_landmarks();
    if (auto smoothed = pipeline_.filter().smoothed_path()) {
      mrpt_files_.correct(*smoothed);
      recorder_.add_smoothed_path(std::move(*smoothed));
    }
    if (request_.parameters.output.mrpt_files)
      if (auto picture = mrpt_files_.render_grid(map)) recorder_.add_picture(std::move(*picture));
    RunSummary summary =
        recorder_.finish(summarize(), map, request_.truth, landmark_identity(request_.parameters));
    if (request_.parameters.output.mrpt_files) mrpt_files_.write(request_.directory, map);
    if (failure_) std::rethrow_exception(failure_);
    return summary;
  }

 private:
  void save_map() {
    if (request_.save_map.empty()) return;
    try {
      write_map_file(request_.save_map, pipeline_.filter().saved_map());
    } catch (const std::invalid_argument& unsound) {
      warnings_.push_back(request_.save_map.string() + " not written: " + unsound.what());
    } catch (const std::runtime_error&) {
      if (!failure_) fail(2, "failed");
    }
  }

  /// A diverged filter may hold landmarks that are no numbers; the others are still worth saving.
  LandmarkMap finite_landmarks() const {
    LandmarkMap map;
    for (auto& landmark : pipeline_.filter().landmarks())
      if (landmark.mean.allFinite() && landmark.cov.allFinite()) map.add(std::move(landmark));
    return map;
  }

  bool stopped() const { return request_.stop != nullptr && request_.stop->load(); }

  void end(int exit_code, const char* status) {
    exit_code_ = exit_code;
    status_ = status;
  }

  void fail(int exit_code, const char* status) {
    failure_ = std::current_exception();
    end(exit_code, status);
  }

  void process(const LogStep& step) {
    const Clock::time_point start = Clock::now();
    StepRecord record;
    try {
      record = pipeline_.process(step);
    } catch (const UnusableOdometry& unusable) {
      if (request_.parameters.input.policy == "strict")
        throw InputError(request_.rawlog + ": " + unusable.what());
      ++unusable_steps_;
      if (warnings_.empty()) warnings_.push_back(unusable.what());
      record = pipeline_.process_frame(step);
    }
    record.step_ms = 1e3 * seconds_since(start);
    if (!pipeline_.filter().healthy() || !std::isfinite(record.nis)) {
      end(6, "diverged: pose, calibration or a variance is not a finite number");
      return;
    }
    any_used_ = any_used_ || record.accepted > 0 || record.new_landmarks > 0;
    unused_sightings_ += record.ambiguous + record.gated;
    recorder_.record(record);
    if (request_.parameters.output.mrpt_files) mrpt_files_.keep(record, step.frame);
    if (!has_picture_ && record.accepted > 0) draw(*step.frame);
    if (request_.on_step) request_.on_step(player_.progress(), record);
  }

  /// The first frame that corrected the filter, where it is one of images.
  void draw(const mrpt::obs::CSensoryFrame& frame) {
    has_picture_ = true;
    if (auto picture = draw_frame(frame, pipeline_.last_features()))
      recorder_.add_picture(std::move(*picture));
  }

  RunSummary summarize() {
    const InputSummary& input = player_.summary();
    const std::int64_t unusable = unusable_steps_ + pipeline_.frontend().unusable();
    if (exit_code_ == 0 && (input.incomplete() || unusable > 0))
      end(5, "part of the input unusable");
    RunSummary summary;
    summary.program = request_.program;
    summary.version = version();
    summary.git = git_revision();
    summary.config_sha256 = sha256_of_text(to_yaml(request_.parameters));
    summary.input_sha256 = sha256_of_file(request_.rawlog);
    summary.seed = request_.seed;
    summary.threads = request_.threads;
    summary.exit_code = exit_code_;
    summary.status = status_;
    summary.result.placement = placement_in(request_.parameters.map);
    summary.input = {request_.rawlog,
                     input.entries,
                     input.actions,
                     input.observations,
                     input.duration_s,
                     input.skipped + unusable,
                     input.repaired,
                     input.warnings,
                     {},
                     {}};
    if (const std::string& map = request_.parameters.map.file; !map.empty()) {
      summary.input.map_file = map;
      summary.input.map_sha256 = sha256_of_file(map);
    }
    auto& warnings = summary.input.warnings;
    warnings.insert(warnings.end(), warnings_.begin(), warnings_.end());
    const auto about_odometry = pipeline_.odometry().warnings();
    warnings.insert(warnings.end(), about_odometry.begin(), about_odometry.end());
    const auto about_features = pipeline_.frontend().warnings();
    warnings.insert(warnings.end(), about_features.begin(), about_features.end());
    if (pipeline_.frontend().unusable() > 0)
      warnings.push_back(std::to_string(pipeline_.frontend().unusable()) +
                         " measurements left out as unusable");
    warn_of_idle_schedule(warnings);
    warn_of_unused_sightings(warnings);
    const auto about_noise = warnings_about(pipeline_.filter().noise());
    warnings.insert(warnings.end(), about_noise.begin(), about_noise.end());
    fill_timing(summary);
    summary.health.features = pipeline_.frontend().figures();
    if (const MatchedOdometry* matched = pipeline_.matched_odometry())
      summary.health.features.merge(matched->figures());
    if (const LoopClosure* loops = pipeline_.filter().loop_closure())
      summary.health.features.merge(loops->figures());
    const Eigen::MatrixXd cov = pipeline_.filter().covariance();
    if (cov.rows() <= kLargestSpectrum && cov.allFinite())
      summary.health.min_eigenvalue =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(cov, Eigen::EigenvaluesOnly)
              .eigenvalues()
              .minCoeff();
    return summary;
  }

  /// An update period means nothing in a log without usable times.
  void warn_of_idle_schedule(std::vector<std::string>& warnings) const {
    const double period = request_.parameters.policies.update_period_s;
    const InputSummary& input = player_.summary();
    if (period > 0.0 && input.observations > 10 && input.duration_s < period)
      warnings.push_back("policies.update_period_s is longer than the whole log: its times span " +
                         std::to_string(input.duration_s) + " s; all but one frame were left out");
  }

  /// A run on odometry alone is legitimate, but rarely what was meant.
  void warn_of_unused_sightings(std::vector<std::string>& warnings) const {
    if (any_used_) return;
    if (request_.parameters.frontend.source == "sensor_path") {
      warnings.push_back(
          "no displacement was used: input.sensor_label must name the odometry of the sensor");
      return;
    }
    warnings.push_back(unused_sightings_ == 0
                           ? "no sighting passed the filters: this is odometry alone"
                           : std::to_string(unused_sightings_) +
                                 " sightings, none used: check the start pose and the gate, and "
                                 "association.method if log and map have no identities in common");
  }

  void fill_timing(RunSummary& summary) const {
    summary.timing.wall_s = seconds_since(start_);
    summary.timing.cpu_s = cpu_seconds() - cpu_start_;
    const PhaseTimes& times = pipeline_.filter().times();
    for (std::size_t i = 0; i < PhaseTimes::kNames.size(); ++i)
      summary.timing.phases[std::string(PhaseTimes::kNames[i])] = times.seconds[i];
    fill_savings(summary.timing);
    summary.timing.peak_rss_mb = peak_memory_mb();
    if (summary.timing.wall_s > 0.0 && summary.input.duration_s > 0.0)
      summary.timing.realtime_factor = summary.input.duration_s / summary.timing.wall_s;
  }

  /// What the schedule saved, at the mean time of all that an update does.
  void fill_savings(RunSummary::Timing& timing) const {
    const auto savings = pipeline_.schedule().savings();
    if (!savings) return;
    timing.updates = savings->updates;
    timing.updates_without_stretch = savings->without_stretch;
    double spent = 0.0;
    for (const auto& [phase, seconds] : timing.phases)
      if (phase != PhaseTimes::kNames[static_cast<std::size_t>(Phase::kPredict)]) spent += seconds;
    if (savings->updates > 0)
      timing.saved_s = spent / static_cast<double>(savings->updates) *
                       static_cast<double>(savings->without_stretch - savings->updates);
  }

  const RunRequest& request_;
  Clock::time_point start_ = Clock::now();
  double cpu_start_ = cpu_seconds();
  RawlogPlayer player_;
  Pipeline pipeline_;
  Recorder recorder_;
  MrptFiles mrpt_files_;
  std::exception_ptr failure_;
  std::vector<std::string> warnings_;
  std::int64_t unusable_steps_ = 0, unused_sightings_ = 0;
  bool any_used_ = false, has_picture_ = false;
  int exit_code_ = 0;
  std::string status_ = "done";
};

}  // namespace

RunSummary run_rawlog(const RunRequest& request) {
  require_folder_of_map(request.save_map);
  Run run(request);
  run.play();
  return run.finish();
}

}  // namespace libslam
