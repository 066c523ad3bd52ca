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

/// Parameters that are out of their own range. Parameters may be filled in by a program, with what
/// no loader would accept.
std::vector<Conflict> find_range_conflicts(const ParameterTable& table);

/// Throws ConfigError with the first conflict, if there is one, in one line that begins with the
/// place of the first of its keys that `places` knows; `table` has the values.
void throw_first(const std::vector<Conflict>& conflicts, const ParameterTable& table,
                 const ParameterPlaces& places);

/// Whether the run is one of a simulation that tells the filter the truth, as the ideal filter of
/// consistency studies needs it.
enum class TruthAccess { kNone, kSimulation };

/// All conflicts, range conflicts first; empty if the parameters can run.
std::vector<Conflict> find_conflicts(const Parameters& parameters,
                                     TruthAccess truth = TruthAccess::kNone);

/// Throws ConfigError with the first conflict, as `throw_first` does.
void validate(const Parameters& parameters, const ParameterPlaces& places = {},
              TruthAccess truth = TruthAccess::kNone);

}  // namespace libslam
