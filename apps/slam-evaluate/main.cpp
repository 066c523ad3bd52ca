// slam-evaluate: compares finished runs with ground truth.

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <libslam/config/yaml_loader.hpp>
#include <libslam/io/exporters/kitti_poses.hpp>
#include <libslam/io/truth_reader.hpp>
#include <libslam/pipeline/landmark_identity.hpp>
#include <libslam/result/recorded_run.hpp>

#include "../program/program.hpp"
#include "batch.hpp"
#include "table.hpp"

namespace {

namespace fs = std::filesystem;
using namespace libslam;
using evaluate::EvaluatedRun;

struct Arguments {
  std::vector<std::string> runs;
  std::string truth, truth_map, relations, steps, placement, export_format;
  RunWindow window;
  bool batch = false, json = false, csv = false, quiet = false, verbose = false;
  int on_line_steps = 0;
};

/// "a/b/" and "a/b" both give "b".
std::string name_of(const fs::path& directory) {
  const fs::path name =
      directory.filename().empty() ? directory.parent_path().filename() : directory.filename();
  return name.string();
}

TruthFiles truth_files_for(const RunSummary& summary, const Arguments& arguments) {
  TruthFiles files;
  if (summary.input.file) files = find_truth(*summary.input.file);
  if (!arguments.truth.empty()) {
    files.path = arguments.truth;
    files.notes_describe_path = false;
  }
  if (!arguments.truth_map.empty()) files.landmarks = arguments.truth_map;
  if (!arguments.relations.empty()) files.relations = arguments.relations;
  return files;
}

LandmarkIdentity identity_of(const fs::path& directory) {
  const fs::path config = directory / "config.yaml";
  return fs::exists(config) ? landmark_identity(load_yaml(config)) : LandmarkIdentity::known;
}

/// FIRST:LAST, either may be missing. Throws CLI::ValidationError.
void read_step_window(const std::string& text, RunWindow& window) {
  const std::size_t colon = text.find(':');
  const auto number = [&](const std::string& part, std::int64_t& value) {
    if (part.empty()) return true;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc{} && end == part.data() + part.size();
  };
  if (colon == std::string::npos || !number(text.substr(0, colon), window.first_step) ||
      !number(text.substr(colon + 1), window.last_step) || window.first_step > window.last_step)
    throw CLI::ValidationError("--steps", "expected FIRST:LAST, not '" + text + "'");
}

std::optional<Placement> placement_of(const Arguments& arguments) {
  if (arguments.placement.empty()) return std::nullopt;
  return arguments.placement == "none" ? Placement::none : Placement::first;
}

/// `warning` says what could not be compared.
EvaluatedRun evaluate_run(const fs::path& directory, const Arguments& arguments,
                          std::string& warning) {
  const RecordedRun recorded = read_recorded_run(directory);
  EvaluatedRun run{name_of(directory), recorded.summary};
  if (arguments.export_format == "kitti")
    write_kitti_poses(directory / "trajectory.kitti", trajectory_of(recorded.path));
  const GroundTruth truth = read_truth(truth_files_for(run.summary, arguments));
  if (truth.empty()) {
    warning = directory.string() + ": no ground truth beside the log; name it with --truth FILE";
    if (run.summary.truth) warning += " (figures are those of the run itself)";
    return run;
  }
  run.summary.truth = compare_with_truth(recorded, truth, identity_of(directory), arguments.window,
                                         placement_of(arguments));
  if (const fs::path smoothed = directory / "trajectory_smoothed.tum"; fs::exists(smoothed))
    compare_smoothed(
        read_true_path(smoothed), recorded.path.poses, truth,
        {placement_of(arguments).value_or(recorded.summary.result.placement), arguments.window},
        *run.summary.truth);
  if (!truth.path.poses.empty() && !run.summary.truth->path)
    warning = directory.string() +
              ": no pose of the run, or of the part of it that was asked for, "
              "is near a true one in time";
  else if (!truth.relations.empty() && !run.summary.truth->relations)
    warning = directory.string() + ": the run has no poses at the times of the relations";
  return run;
}

/// Calls `evaluate` on every run; returns whether all went well. What did not is said.
template <typename Evaluate>
bool for_each_run(const Arguments& arguments, Evaluate&& evaluate) {
  bool complete = true;
  for (const std::string& directory : arguments.runs) {
    std::string warning;
    try {
      evaluate(fs::path(directory), warning);
    } catch (const std::exception& error) {
      warning = error.what();
    }
    if (warning.empty()) continue;
    complete = false;
    std::cerr << "slam-evaluate: " << warning << '\n';
  }
  return complete;
}

int run_batch(const Arguments& arguments) {
  std::vector<evaluate::BatchEvaluation> runs;
  const bool complete = for_each_run(arguments, [&](const fs::path& directory, std::string&) {
    const RunSummary summary = read_run_summary(directory / "run.json");
    const GroundTruth truth = read_truth(truth_files_for(summary, arguments));
    runs.push_back(evaluate::evaluate_batch(directory, name_of(directory), summary, truth,
                                            arguments.on_line_steps));
    if (!arguments.json && !arguments.quiet)
      std::cout << evaluate::to_text(runs.back(), arguments.verbose) << std::flush;
  });
  if (runs.empty()) return kInput;
  if (arguments.json) std::cout << evaluate::to_json(runs);
  return complete ? kDone : kIncomplete;
}

int run(const Arguments& arguments) {
  std::vector<EvaluatedRun> runs;
  const bool complete =
      for_each_run(arguments, [&](const fs::path& directory, std::string& warning) {
        runs.push_back(evaluate_run(directory, arguments, warning));
      });
  if (runs.empty()) return kInput;
  if (arguments.json)
    std::cout << evaluate::to_json(runs);
  else if (arguments.csv)
    std::cout << evaluate::to_csv(runs, evaluate::figures_of(runs, true));
  else if (!arguments.quiet)
    std::cout << evaluate::to_table(runs, evaluate::figures_of(runs, arguments.verbose));
  return complete ? kDone : kIncomplete;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Compares runs of slam-run with ground truth and prints a table.", "slam-evaluate");
  app.add_option("RUN", arguments.runs, "Run directories")->required();
  app.add_option(
      "--truth", arguments.truth,
      "True path (TUM, or the text form of MRPT); default: beside the rawlog of each run");
  app.add_option("--truth-map", arguments.truth_map,
                 "True landmarks (id,x,y[,z], or the text form of MRPT)");
  app.add_option("--relations", arguments.relations,
                 "Relations of the Freiburg SLAM benchmark (t1 t2 x y z roll pitch yaw, times of "
                 "the source); default: beside the rawlog of each run");
  auto* steps = app.add_option("--steps", arguments.steps,
                               "Path figures of the steps FIRST:LAST only (placed as a whole run)");
  auto* from = app.add_option("--from", arguments.window.from_s,
                              "Path figures from this time on [s since the first step]");
  auto* to = app.add_option("--to", arguments.window.to_s, "Path figures up to this time [s]");
  auto* placement =
      app.add_option("--placement", arguments.placement,
                     "first: raw figures place the first pose of a run on the true one; none: the "
                     "run is in the frame of the truth. Default: what run.json says, else first")
          ->check(CLI::IsMember({"first", "none"}));
  app.add_option("--export", arguments.export_format,
                 "kitti: write the path as trajectory.kitti into each run")
      ->check(CLI::IsMember({"kitti"}));
  auto* json = app.add_flag("--json", arguments.json, "Print JSON with the keys of run.json");
  auto* csv = app.add_flag("--csv", arguments.csv, "Print CSV, one line per run")->excludes(json);
  auto* batch =
      app.add_flag(
             "--batch", arguments.batch,
             "Solve each run again as one least-squares problem over its log, print the filter "
             "beside this optimum, and write batch.json into the run")
          ->excludes(csv)
          ->excludes(steps)
          ->excludes(from)
          ->excludes(to)
          ->excludes(placement);
  app.add_option("--on-line", arguments.on_line_steps,
                 "With --batch: also solve the log up to each of so many steps, which is what the "
                 "path of a filter can be held against")
      ->needs(batch)
      ->check(CLI::Range(1, 100000));
  auto* quiet = app.add_flag("-q,--quiet", arguments.quiet,
                             "Print no table; errors and the exit code remain");
  app.add_flag("-v,--verbose", arguments.verbose, "Print all figures")->excludes(quiet);
  app.set_version_flag("--version", version_line("slam-evaluate"));
  app.footer(
      "Examples: slam-evaluate run1 run2 --truth robot.truth.tum\n"
      "          slam-evaluate run1 --steps 1215:1714 --placement none\n"
      "          slam-evaluate --batch run1\n"
      "Exit codes: 0 done, 2 wrong command line, 4 no run could be read, 5 some figures are "
      "missing.");
  return run_program(app, argc, argv,
                     [&] {
                       if (!arguments.steps.empty())
                         read_step_window(arguments.steps, arguments.window);
                       return arguments.batch ? run_batch(arguments) : run(arguments);
                     },
                     {kInput, kInput});
}
