#pragma once
// What the command line of slam-run asks for.

#include <cstdint>
#include <string>
#include <vector>

#include <libslam/config/parameters.hpp>
#include <libslam/io/truth_reader.hpp>

namespace libslam {

struct Arguments {
  std::string config, rawlog, out, truth, truth_map, input_policy, load_map, save_map;
  std::vector<std::string> settings;
  std::string help_config;
  std::uint64_t seed = 0;
  int threads = 1;
  double speed = 0.0;
  bool force = false, quiet = false, verbose = false, print_config = false;
};

struct Job {
  Parameters parameters;
  TruthFiles truth;
  std::vector<std::string> notes;
};

/// Reads the configuration and completes the arguments with what an ini file names. Throws
/// ConfigError and InputError.
Job load_job(Arguments& arguments);

}  // namespace libslam
