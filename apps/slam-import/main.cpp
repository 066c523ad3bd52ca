// slam-import: a data set in its own format in, a standard MRPT rawlog and its ground truth out.

#include <csignal>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include <libslam/config/version.hpp>
#include <libslam/io/input_error.hpp>

#include "command.hpp"

namespace {

using namespace libslam;

enum ExitCode { kDone = 0, kCommandLine = 2, kInput = 4, kInterrupted = 7 };

volatile std::sig_atomic_t g_stop = 0;

int run_chosen(const Commands& commands, const CommonArguments& arguments) {
  for (const Command& command : commands)
    if (command.app->parsed())
      return command.run(arguments, [] { return g_stop != 0; }) ? kDone : kInterrupted;
  return kCommandLine;
}

}  // namespace

int main(int argc, char** argv) {
  CommonArguments arguments;
  Commands commands;
  CLI::App app{"Converts a public data set, or CSV files, to an MRPT rawlog with ground truth."};
  app.set_version_flag("--version", "slam-import " + std::string(version()) + " (" +
                                        std::string(git_revision()) + ")");
  app.require_subcommand(1);
  app.footer(
      "Example:\n  slam-import mrclam MRCLAM_Dataset6 --robot 1 --out mrclam6_r1.rawlog\n"
      "Writes X.rawlog, X.truth.json and, where known, X.truth.tum and X.landmarks.csv.");
  add_planar_data_sets(app, arguments, commands);
  add_spatial_data_sets(app, arguments, commands);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kCommandLine;
  }
  std::signal(SIGINT, [](int) { g_stop = 1; });
  std::signal(SIGTERM, [](int) { g_stop = 1; });
  try {
    return run_chosen(commands, arguments);
  } catch (const InputError& error) {
    std::cerr << "slam-import: " << error.what() << '\n';
    return kInput;
  } catch (const std::exception& error) {
    std::cerr << "slam-import: " << error.what() << '\n';
    return kCommandLine;
  }
}
