#pragma once
// The parameters of a run as one flat table: what loaders check against and what help prints.

#include <string>
#include <string_view>
#include <vector>

#include <libslam/config/parameters.hpp>

namespace libslam {

enum class ParameterType { kBool, kInteger, kReal, kText };

/// One parameter with its value and everything the description says about it.
struct ParameterEntry {
  std::string name;  ///< with its sections: "motion.noise.from_log"
  ParameterType type = ParameterType::kText;
  std::string value;  ///< as `assign_parameter` reads it back; reals round-trip exactly
  Describe description;

  std::string_view section() const;  ///< "motion.noise"
  std::string_view key() const;      ///< "from_log"
};

/// All parameters in the order of their definition, sections contiguous.
std::vector<ParameterEntry> list_parameters(const Parameters& parameters);

/// Sets the parameter called `name` from its text form.
/// Throws ConfigError (without a place) if there is no such parameter, or the value is of the wrong
/// type, not finite, out of range or none of the choices.
void assign_parameter(Parameters& parameters, std::string_view name, std::string_view value);

/// The names of all sections, "motion" and "motion.noise" among them.
std::vector<std::string> list_sections();

/// The parameter or section whose name is nearest to a misspelled one. The place counts less than
/// the word: "trak_width" finds "motion.track_width".
std::string find_nearest_name(std::string_view name);

/// "a number >= 0 [m]", "one of left, right" ...: what a value of `entry` must be.
std::string describe_domain(const ParameterEntry& entry);

}  // namespace libslam
