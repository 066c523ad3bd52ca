// slam-import: a data set in its own format in, a standard MRPT rawlog and its ground truth out.

#include <string>

#include <CLI/CLI.hpp>

#include "../program/program.hpp"
#include "command.hpp"

namespace {

using namespace libslam;

int run_chosen(const Commands& commands, const CommonArguments& arguments) {
  const std::atomic<bool>& stop = stop_on_signals();
  for (const Command& command : commands)
    if (command.app->parsed())
      return command.run(arguments, [&stop] { return stop.load(); }) ? kDone : kInterrupted;
  return kCommandLine;
}

}  // namespace

int main(int argc, char** argv) {
  CommonArguments arguments;
  Commands commands;
  CLI::App app{"Converts a public data set, or CSV files, to an MRPT rawlog with ground truth.",
               "slam-import"};
  app.set_version_flag("--version", version_line("slam-import"));
  app.require_subcommand(1);
  app.footer(
      "Example:\n  slam-import mrclam MRCLAM_Dataset6 --robot 1 --out mrclam6_r1.rawlog\n"
      "Writes X.rawlog, X.truth.json and, where known, X.truth.tum, X.landmarks.csv and "
      "X.relations.");
  add_planar_data_sets(app, arguments, commands);
  add_laser_data_sets(app, arguments, commands);
  add_spatial_data_sets(app, arguments, commands);
  return run_program(app, argc, argv, [&] { return run_chosen(commands, arguments); },
                     {kCommandLine, kCommandLine});
}
