// slam-run: a rawlog and a configuration in, path, map, uncertainty and report out.

#include <filesystem>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include <libslam/config/help.hpp>
#include <libslam/config/yaml_loader.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/truth_reader.hpp>
#include <libslam/pipeline/run.hpp>

#include "../program/program.hpp"
#include "console.hpp"
#include "job.hpp"
#include "summary_text.hpp"

namespace {

namespace fs = std::filesystem;
using namespace libslam;

fs::path fresh_directory(const std::string& rawlog) {
  const std::string stem = "run-" + fs::path(rawlog).stem().string() + "-";
  for (int i = 1;; ++i)
    if (const fs::path candidate = stem + std::to_string(i); !fs::exists(candidate))
      return candidate;
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
  Job job = load_job(arguments);
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
  request.stop = &stop_on_signals();
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
  app.set_version_flag("--version", version_line("slam-run"));
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
      "Runs SLAM over an MRPT rawlog: path, map, uncertainty, calibrated odometry, report.",
      "slam-run");
  Arguments arguments;
  add_options(app, arguments);
  return run_program(app, argc, argv, [&] {
    if (app.count("--help-config") > 0) {
      std::cout << (arguments.help_config == "markdown" ? help_markdown() : help_text());
      return static_cast<int>(kDone);
    }
    return run(arguments);
  });
}
