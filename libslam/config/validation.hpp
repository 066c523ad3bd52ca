#pragma once
// Combinations of parameters that are legal one by one and unsound together.

#include <string>
#include <vector>

#include <libslam/config/config_error.hpp>
#include <libslam/config/parameters.hpp>
#include <libslam/config/yaml_loader.hpp>

namespace libslam {

/// Why some parameters cannot stand together.
struct Conflict {
  std::vector<std::string> keys;  ///< full names; the first is the one to change
  std::string reason;             ///< one sentence
};

/// All conflicts, in the order of the sections; empty if the parameters can run.
///
/// Values out of their own range are conflicts too, because parameters may be filled in by a
/// program.
std::vector<Conflict> find_conflicts(const Parameters& parameters);

/// Throws ConfigError with the first conflict, in one line that begins with the place of the first
/// of its keys that `places` knows.
void validate(const Parameters& parameters, const ParameterPlaces& places = {});

}  // namespace libslam
