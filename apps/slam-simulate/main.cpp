// slam-simulate: a scenario in; a standard MRPT rawlog, its ground truth and the effective scenario
// out.

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <libslam/config/help.hpp>
#include <libslam/pipeline/simulated_drive.hpp>
#include <libslam/pipeline/simulation.hpp>

#include "../program/program.hpp"

namespace {

namespace fs = std::filesystem;
using namespace libslam;

struct Arguments {
  std::string config, out, help_config;
  std::vector<std::string> settings;
  int seed = 0;
  bool seed_given = false;
  bool force = false, quiet = false, verbose = false, print_config = false;
};

Scenario load(const Arguments& arguments) {
  Scenario scenario;
  ParameterPlaces places;
  if (!arguments.config.empty()) scenario = load_scenario(arguments.config, &places);
  for (const std::string& setting : arguments.settings)
    set_parameter(ParameterTable(scenario), setting, &places);
  if (arguments.seed_given) scenario.seed = arguments.seed;
  validate(scenario, places);
  return scenario;
}

/// X.rawlog for `--out X` and `--out X.rawlog` alike.
fs::path rawlog_of(const Arguments& arguments) {
  if (!arguments.out.empty()) {
    const fs::path out(arguments.out);
    return out.extension() == ".rawlog" ? out : fs::path(arguments.out + ".rawlog");
  }
  const std::string stem =
      arguments.config.empty() ? "sim" : fs::path(arguments.config).stem().string();
  for (int i = 1;; ++i)
    if (const fs::path file = stem + "-" + std::to_string(i) + ".rawlog"; !fs::exists(file))
      return file;
}

int simulate(const Arguments& arguments) {
  DriveRequest request;
  request.scenario = load(arguments);
  if (arguments.print_config) {
    std::cout << to_yaml(ParameterTable(request.scenario));
    return kDone;
  }
  request.rawlog = rawlog_of(arguments);
  if (fs::exists(request.rawlog) && !arguments.force)
    throw std::runtime_error(request.rawlog.string() + " exists; --force replaces it");
  request.stop = &stop_on_signals();
  DriveSummary summary;
  {
    ProgressBar progress(arguments.quiet);
    request.on_step = [&progress](double fraction) { progress.show(fraction); };
    summary = simulate_drive(request);
  }
  if (!arguments.quiet) {
    std::printf("%s%s: %lld steps, %lld observations, %.1f s, %.1f m\n",
                summary.exit_code == kDone ? "" : "interrupted, partial results saved: ",
                request.rawlog.c_str(), static_cast<long long>(summary.steps),
                static_cast<long long>(summary.observations), summary.duration_s,
                summary.distance_m);
    if (arguments.verbose)
      std::printf("  seed %d, vehicle %s, world %s\n", request.scenario.seed,
                  request.scenario.motion.model.c_str(), request.scenario.world.generator.c_str());
  }
  return summary.exit_code;
}

void add_options(CLI::App& app, Arguments& arguments) {
  app.add_option("config", arguments.config, "Scenario, a .yaml file; left out: the defaults");
  app.add_option("--out", arguments.out,
                 "Name X of the files to write, with or without .rawlog; default: a new one");
  app.add_option("--seed", arguments.seed, "Seed of the drive; default: the scenario's")
      ->check(CLI::NonNegativeNumber);
  app.add_flag("--force", arguments.force, "Replace the files of an earlier drive");
  app.add_option("--set", arguments.settings, "section.key=value, repeatable")
      ->allow_extra_args(false);
  app.add_flag("--print-config", arguments.print_config, "Print the effective scenario and stop");
  app.add_option("--help-config", arguments.help_config,
                 "Print every key of a scenario: text or markdown")
      ->expected(0, 1)
      ->default_str("text")
      ->check(CLI::IsMember({"text", "markdown"}));
  app.add_flag("-q,--quiet", arguments.quiet, "Print errors only");
  app.add_flag("-v,--verbose", arguments.verbose, "Print more");
  app.set_version_flag("--version", version_line("slam-simulate"));
  app.footer(
      "Example: slam-simulate config/sim_webmap.yaml --seed 7 --out sim1\n"
      "Writes X.rawlog, X.truth.tum, X.truth.csv, X.landmarks.csv, X.truth.json, X.scenario.yaml,\n"
      "and X.filter.yaml, what the robot knows about itself: slam-run X.filter.yaml X.rawlog");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes a world, drives a vehicle through it and writes what its sensors say.",
               "slam-simulate");
  Arguments arguments;
  add_options(app, arguments);
  return run_program(app, argc, argv, [&] {
    if (app.count("--help-config") > 0) {
      Scenario scenario;
      const ParameterTable table(scenario);
      std::cout << (arguments.help_config == "markdown" ? help_tables(table) : help_text(table));
      return static_cast<int>(kDone);
    }
    arguments.seed_given = app.count("--seed") > 0;
    return simulate(arguments);
  });
}
