#pragma once
// Subcommands of slam-import: one per data set, in a file per group of data sets.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

/// What every data set is imported with.
struct CommonArguments {
  std::string out, directory;  ///< `directory`: or file, whatever the data set is read from
  bool quiet = false, verbose = false;
};

/// Asked for every entry that is written; true ends the rawlog there.
using Interrupted = std::function<bool()>;

/// A data set. `run` reads and writes it and returns false if it was interrupted.
struct Command {
  CLI::App* app;
  std::function<bool(const CommonArguments&, const Interrupted&)> run;
};
using Commands = std::vector<Command>;

/// What a data set is read from, as --help says it.
struct Source {
  std::string name = "directory", text = "Directory of the data set";
  bool required = true;
};

/// A subcommand with the options that all have in common.
CLI::App* add_subcommand(CLI::App& app, CommonArguments& arguments, const std::string& name,
                         const std::string& text, const Source& source = {});

/// The end of the one line about an import: parameters and remarks on demand.
void print_notes(const CommonArguments& arguments, const std::map<std::string, double>& parameters,
                 const std::map<std::string, std::string>& remarks);

/// Odometry on the ground and landmarks by range and bearing.
void add_planar_data_sets(CLI::App& app, CommonArguments& arguments, Commands& commands);
/// Odometry on the ground and raw scans of a laser.
void add_laser_data_sets(CLI::App& app, CommonArguments& arguments, Commands& commands);
/// Velocities in space and points of a stereo camera.
void add_spatial_data_sets(CLI::App& app, CommonArguments& arguments, Commands& commands);
