#pragma once
// What one call of slam-campaign does, once its command line is understood.

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "../program/program.hpp"
#include "cluster.hpp"

namespace libslam {

struct Arguments {
  std::string config, out, help_config;
  std::vector<std::string> settings;
  std::optional<int> runs, batches, seed;
  int threads = 0;  ///< 0: all cores
  bool resume = false, force = false, quiet = false, verbose = false, print_config = false;
  bool report = true;
};

/// Runs or resumes the campaign, prints and writes its results. `cluster`: null without MPI.
/// Throws ConfigError and InputError as load_campaign does, and std::runtime_error where the
/// directory or its files cannot be used.
ExitCode run_campaign(const Arguments& arguments, const Cluster* cluster,
                      const std::atomic<bool>& stop);

}  // namespace libslam
