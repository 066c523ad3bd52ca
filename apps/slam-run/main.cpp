// slam-run: a rawlog and a configuration in, path, map, uncertainty and report out.

#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

#include <CLI/CLI.hpp>

#include <libslam/config/config_error.hpp>
#include <libslam/config/help.hpp>
#include <libslam/config/ini_loader.hpp>
#include <libslam/config/validation.hpp>
#include <libslam/config/version.hpp>
#include <libslam/config/yaml_loader.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/truth_reader.hpp>
#include <libslam/pipeline/run.hpp>

namespace {

namespace fs = std::filesystem;
using namespace libslam;

enum ExitCode { kDone = 0, kCommandLine = 2, kConfiguration = 3, kInput = 4 };

std::atomic<bool> g_stop{false};

struct Arguments {
  std::string config, rawlog, out, truth, truth_map, input_policy, load_map, save_map;
  std::vector<std::string> settings;
  std::string help_config;
  std::uint64_t seed = 0;
  int threads = 1;
  double speed = 0.0;
  bool force = false, quiet = false, verbose = false, print_config = false;
};

/// Prints lines and remembers them for log.txt.
class Console {
 public:
  explicit Console(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

  void say(const std::string& line) {
    log_ << line << '\n';
    if (!quiet_) std::cout << line << '\n';
  }
  void warn(const std::string& line) {
    log_ << line << '\n';
    clear_progress();
    std::cerr << line << '\n';
  }
  void log(const std::string& line) { log_ << line << '\n'; }
  void progress(double fraction) {
    const int percent = static_cast<int>(100.0 * fraction);
    if (quiet_ || !terminal_ || percent == shown_) return;
    shown_ = percent;
    std::fprintf(stderr, "\r[%-40.*s] %3d %%", 40, std::string(percent * 2 / 5, '#').c_str(),
                 percent);
  }
  void clear_progress() {
    if (shown_ >= 0) std::fputs("\r\033[K", stderr);
    shown_ = -1;
  }
  void save(const fs::path& file) const { std::ofstream(file) << log_.str(); }

 private:
  bool quiet_, terminal_;
  int shown_ = -1;
  std::ostringstream log_;
};

fs::path fresh_directory(const std::string& rawlog) {
  const std::string stem = "run-" + fs::path(rawlog).stem().string() + "-";
  for (int i = 1;; ++i)
    if (const fs::path candidate = stem + std::to_string(i); !fs::exists(candidate))
      return candidate;
}

struct Job {
  Parameters parameters;
  ParameterPlaces places;
  TruthFiles truth;
  std::vector<std::string> notes;
};

bool is_config(const std::string& file) {
  const std::string extension = fs::path(file).extension();
  return extension == ".yaml" || extension == ".yml" || extension == ".ini";
}

/// Reads the configuration, completes the arguments with what an ini file names.
Job load(Arguments& arguments) {
  Job job;
  if (!is_config(arguments.config) && (arguments.rawlog.empty() || is_config(arguments.rawlog)))
    std::swap(arguments.rawlog, arguments.config);
  const std::string extension = fs::path(arguments.config).extension();
  if (extension == ".ini") {
    KfSlamIni ini = load_kf_slam_ini(arguments.config);
    job.parameters = ini.parameters;
    job.notes = ini.notes;
    if (arguments.rawlog.empty()) arguments.rawlog = ini.rawlog_file.value_or("");
    job.truth.path = ini.ground_truth_file_robot.value_or("");
    job.truth.landmarks = ini.ground_truth_file.value_or("");
  } else if (!arguments.config.empty()) {
    job.parameters = load_yaml(arguments.config, &job.places);
  }
  for (const auto& setting : arguments.settings)
    set_parameter(job.parameters, setting, &job.places);
  if (!arguments.input_policy.empty())
    set_parameter(job.parameters, "input.policy=" + arguments.input_policy, &job.places);
  if (!arguments.load_map.empty())
    set_parameter(job.parameters, "map.file=" + arguments.load_map, &job.places);
  validate(job.parameters, job.places);
  const TruthFiles beside = arguments.rawlog.empty() ? TruthFiles{} : find_truth(arguments.rawlog);
  job.truth.notes = beside.notes;
  job.truth.notes_describe_path = job.truth.path.empty() && arguments.truth.empty();
  if (job.truth.path.empty()) job.truth.path = beside.path;
  if (job.truth.landmarks.empty()) job.truth.landmarks = beside.landmarks;
  if (!arguments.truth.empty()) job.truth.path = arguments.truth;
  if (!arguments.truth_map.empty()) job.truth.landmarks = arguments.truth_map;
  return job;
}

std::string number(double value, const char* format = "%.4g") {
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

void report(const RunSummary& summary, const fs::path& directory, Console& console) {
  const auto& timing = summary.timing;
  console.say(summary.status + ": " + std::to_string(timing.steps) + " steps, " +
              std::to_string(summary.result.landmarks) + " landmarks, " + number(timing.wall_s) +
              " s");
  for (const auto& parameter : summary.result.calibration)
    console.say("  " + parameter.name + " = " + number(parameter.mean, "%.5f") + " +- " +
                number(parameter.sigma, "%.5f") +
                (parameter.observable ? "" : "  (not observable in this log)"));
  if (summary.truth && summary.truth->path) {
    const auto& path = *summary.truth->path;
    if (path.raw) console.say("  path error (RMSE): " + number(path.raw->rmse_m) + " m raw");
    if (path.aligned)
      console.say("  path error (RMSE): " + number(path.aligned->rmse_m) + " m aligned");
  }
  if (summary.truth && summary.truth->map && summary.truth->map->rmse_aligned_m)
    console.say("  map error (RMSE): " + number(*summary.truth->map->rmse_aligned_m) +
                " m aligned, " + std::to_string(summary.truth->map->missed) + " missed, " +
                std::to_string(summary.truth->map->duplicates) + " duplicates");
  if (summary.truth && summary.truth->nees)
    console.say("  mean NEES of the pose: " + number(summary.truth->nees->mean) + " (ideal " +
                std::to_string(summary.truth->nees->dof) + ")");
  for (const auto& warning : summary.input.warnings) console.warn("warning: " + warning);
  const fs::path page = directory / "report.html";
  console.say((fs::exists(page) ? "report: " + page.string() : "results: " + directory.string()));
}

/// What --verbose adds: where the time went and how the innovations behaved.
void report_details(const RunSummary& summary, Console& console) {
  const auto& input = summary.input;
  console.say("  log: " + std::to_string(input.entries) + " entries, " +
              std::to_string(input.observations) + " observations, " + number(input.duration_s) +
              " s; " + std::to_string(input.skipped) + " skipped, " +
              std::to_string(input.repaired) + " repaired");
  if (summary.health.nis_mean)
    console.say("  NIS per degree of freedom: " + number(*summary.health.nis_mean) + " (ideal 1)");
  if (summary.health.gated_fraction)
    console.say("  gated: " + number(100.0 * *summary.health.gated_fraction) + " %");
  for (const auto& [phase, seconds] : summary.timing.phases)
    console.say("  " + phase + ": " + number(seconds) + " s");
}

/// Truth that was asked for must be readable; truth that merely stands beside the log need not be.
GroundTruth read_known_truth(const TruthFiles& files, const Arguments& arguments,
                             Console& console) {
  try {
    return read_truth(files);
  } catch (const InputError& e) {
    if (!arguments.truth.empty() || !arguments.truth_map.empty()) throw;
    console.warn(std::string("warning: no comparison with truth: ") + e.what());
    return {};
  }
}

/// Figures that say that the result should not be trusted.
void report_doubts(const RunSummary& summary, const GroundTruth& truth, Console& console) {
  constexpr double kAbsurd = 3.0;
  if (summary.health.nis_mean && *summary.health.nis_mean > kAbsurd)
    console.warn(
        "warning: innovations are " + number(*summary.health.nis_mean) +
        " times what the configured noise allows (NIS per degree of freedom): the noise is "
        "too small for this log, or the association wrong");
  if (!truth.path.poses.empty() && !(summary.truth && summary.truth->path))
    console.warn("warning: the true path does not overlap the log in time: no comparison");
}

RunSummary run_and_log_failures(const RunRequest& request, Console& console) {
  try {
    return run_rawlog(request);
  } catch (const std::exception& e) {
    console.clear_progress();
    console.log(std::string("slam-run: ") + e.what());
    if (fs::exists(request.directory / "run.json")) console.save(request.directory / "log.txt");
    throw;
  }
}

int run(Arguments arguments) {
  Console console(arguments.quiet);
  Job job = load(arguments);
  if (arguments.print_config) {
    std::cout << to_yaml(job.parameters);
    return kDone;
  }
  if (arguments.rawlog.empty()) throw CLI::RequiredError("a rawlog (slam-run [CONFIG] RAWLOG)");
  for (const auto& note : job.notes) console.warn("note: " + note);

  RunRequest request;
  request.program = "slam-run";
  request.rawlog = arguments.rawlog;
  request.parameters = job.parameters;
  request.truth = read_known_truth(job.truth, arguments, console);
  request.directory =
      arguments.out.empty() ? fresh_directory(arguments.rawlog) : fs::path(arguments.out);
  request.save_map = arguments.save_map;
  request.force = arguments.force;
  request.seed = arguments.seed;
  request.threads = arguments.threads;
  if (arguments.speed > 0.0) request.pacing = {PaceMode::kRealTime, arguments.speed, nullptr};
  request.stop = &g_stop;
  request.on_step = [&console](double fraction, const StepRecord&) { console.progress(fraction); };
  const RunSummary summary = run_and_log_failures(request, console);
  console.clear_progress();
  report(summary, request.directory, console);
  report_doubts(summary, request.truth, console);
  if (arguments.verbose) report_details(summary, console);
  console.save(request.directory / "log.txt");
  return summary.exit_code;
}

void add_options(CLI::App& app, Arguments& arguments) {
  app.add_option(
      "config", arguments.config,
      "Configuration: a .yaml file, or an ini file of MRPT's kf-slam; left out: the defaults");
  app.add_option("rawlog", arguments.rawlog, "The log to process");
  app.add_option("--out", arguments.out, "Run directory; default: a new one, run-LOG-N");
  app.add_flag("--force", arguments.force, "Replace the files of an earlier run in --out");
  app.add_option("--set", arguments.settings, "section.key=value, repeatable")
      ->allow_extra_args(false);
  app.add_option("--truth", arguments.truth,
                 "True path (TUM, or MRPT's text form); default: beside the rawlog");
  app.add_option("--truth-map", arguments.truth_map, "True landmarks (id,x,y or MRPT's text form)");
  app.add_option("--save-map", arguments.save_map,
                 "Write the map at the end: FILE for --load-map, and a readable .csv beside it")
      ->check([](const std::string& file) {
        return fs::path(file).extension() == ".csv" ? "the .csv is written beside FILE" : "";
      });
  app.add_option("--load-map", arguments.load_map,
                 "Start in a map of --save-map, or in surveyed landmarks (id,x,y[,z]); "
                 "map.mode: localize (default) or continue; map.start: where");
  app.add_option("--input-policy", arguments.input_policy, "strict, skip or repair");
  app.add_option("--speed", arguments.speed,
                 "Play at this multiple of real time; default: as fast as possible")
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", arguments.seed, "Seed of random numbers; recorded in run.json");
  app.add_option("--threads", arguments.threads, "Most threads to use; this filter needs one")
      ->check(CLI::PositiveNumber);
  app.add_flag("--print-config", arguments.print_config,
               "Print the effective configuration and stop");
  app.add_option("--help-config", arguments.help_config,
                 "Print every configuration key: text or markdown")
      ->expected(0, 1)
      ->default_str("text")
      ->check(CLI::IsMember({"text", "markdown"}));
  app.add_flag("-q,--quiet", arguments.quiet, "Print warnings and errors only");
  app.add_flag("-v,--verbose", arguments.verbose, "Print more");
  app.set_version_flag(
      "--version", "slam-run " + std::string(version()) + " (" + std::string(git_revision()) + ")");
  app.footer(
      "Examples:\n"
      "  slam-run config/range_bearing.yaml kf-slam_demo.rawlog --out run1\n"
      "  slam-run config/range_bearing.yaml monday.rawlog --save-map hall.slammap\n"
      "  slam-run config/range_bearing.yaml tuesday.rawlog --load-map hall.slammap\n"
      "    localizes where monday ended; to go on mapping:     --set map.mode=continue\n"
      "    to start elsewhere in the map:  --set map.start=given_pose --set map.initial_x=2.5\n"
      "  slam-run config/range_bearing.yaml sim.rawlog --load-map sim.landmarks.csv "
      "--set map.start=given_pose");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Runs SLAM over an MRPT rawlog: path, map, uncertainty, calibrated odometry, report.");
  Arguments arguments;
  add_options(app, arguments);
  try {
    app.parse(argc, argv);
    if (app.count("--help-config") > 0) {
      std::cout << (arguments.help_config == "markdown" ? help_markdown() : help_text());
      return kDone;
    }
    std::signal(SIGINT, [](int) { g_stop = true; });
    std::signal(SIGTERM, [](int) { g_stop = true; });
    return run(arguments);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? kDone : kCommandLine;
  } catch (const ConfigError& e) {
    std::cerr << "slam-run: " << e.what() << '\n';
    return kConfiguration;
  } catch (const std::invalid_argument& e) {
    std::cerr << "slam-run: " << e.what() << '\n';
    return kConfiguration;
  } catch (const InputError& e) {
    std::cerr << "slam-run: " << e.what() << '\n';
    return kInput;
  } catch (const std::exception& e) {
    std::cerr << "slam-run: " << e.what() << '\n';
    return kCommandLine;
  }
}
