// slam-campaign: many simulated runs of many filters, on all cores or on many machines.

#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include <libslam/campaign/campaign_help.hpp>

#include "../program/program.hpp"
#include "cluster.hpp"
#include "session.hpp"

namespace {

using namespace libslam;

void add_options(CLI::App& app, Arguments& arguments) {
  app.add_option("config", arguments.config, "The campaign, a .yaml file");
  app.add_option("--out", arguments.out, "Directory of the results; default: campaign-CONFIG-N");
  app.add_option("--runs", arguments.runs, "Runs of each batch")->check(CLI::PositiveNumber);
  app.add_option("--batches", arguments.batches, "Batches")->check(CLI::PositiveNumber);
  app.add_option("--seed", arguments.seed, "Seed of the first run")->check(CLI::NonNegativeNumber);
  app.add_option("--set", arguments.settings,
                 "campaign.KEY=V, scenario.KEY=V or filter.KEY=V; repeatable")
      ->allow_extra_args(false);
  app.add_option("--threads", arguments.threads,
                 "Threads; default: all cores. Under mpirun every process has one")
      ->check(CLI::Range(1, 1024));
  auto* force = app.add_flag("--force", arguments.force, "Replace the campaign in --out");
  app.add_flag("--resume", arguments.resume,
               "Go on with the campaign in --out, or begin it where the directory is empty")
      ->needs("--out")
      ->excludes(force);
  app.add_flag("--print-config", arguments.print_config,
               "Print every effective scenario and filter, and stop");
  app.add_option("--help-config", arguments.help_config,
                 "Print every key of a campaign and its scenario: text or markdown")
      ->expected(0, 1)
      ->default_str("text")
      ->check(CLI::IsMember({"text", "markdown"}));
  app.add_flag("!--no-report", arguments.report, "Do not write report.html");
  auto* quiet = app.add_flag("-q,--quiet", arguments.quiet, "Print errors only");
  app.add_flag("-v,--verbose", arguments.verbose, "Say beforehand what there is to do")
      ->excludes(quiet);
  app.set_version_flag("--version", version_line("slam-campaign"));
  app.footer(
      "Example: slam-campaign config/mc_webmap.yaml --runs 50\n"
      "On many machines: mpirun -n 64 slam-campaign config/mc_webmap.yaml --out DIR\n"
      "Exit codes: 0 done, 2 command line or directory, 3 configuration, 4 files of the world,\n"
      "5 done but some runs failed twice, 7 interrupted (--resume goes on).");
}

ExitCode act(const CLI::App& app, const Arguments& arguments, const Cluster* cluster) {
  if (app.count("--help-config") > 0) {
    if (cluster == nullptr || cluster->rank() == 0)
      std::cout << (arguments.help_config == "markdown" ? campaign_help_markdown()
                                                        : campaign_help_text());
    return kDone;
  }
  if (arguments.config.empty()) throw CLI::RequiredError("config");
  return run_campaign(arguments, cluster, stop_on_signals());
}

ExitCode parse_and_act(int argc, char** argv, const Cluster* cluster) {
  CLI::App app("Monte-Carlo runs and parameter sweeps: simulated logs, compared filters.");
  Arguments arguments;
  add_options(app, arguments);
  try {
    app.parse(argc, argv);
    return act(app, arguments, cluster);
  } catch (const CLI::ParseError& e) {  // the same in all processes
    if (cluster == nullptr || cluster->rank() == 0) app.exit(e);
    return e.get_exit_code() == 0 ? kDone : kCommandLine;
  } catch (const std::exception& e) {
    const ExitCode code = describe_failure("slam-campaign", e);
    if (cluster != nullptr) Cluster::abort(code);  // the others must not wait for this one
    return code;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (!Cluster::launched()) return parse_and_act(argc, argv, nullptr);
  const Cluster cluster(argc, argv);
  return parse_and_act(argc, argv, &cluster);
}
