#include <algorithm>

#include <libslam/config/parameter_table.hpp>
#include <libslam/config/rules/rules.hpp>

namespace libslam {

std::vector<Conflict> find_range_conflicts(const ParameterTable& table) {
  Conflicts conflicts;
  for (const ParameterEntry& entry : list_parameters(table)) {
    try {
      assign_parameter(table, entry.name, entry.value);
    } catch (const ConfigError& error) {
      const std::string message = error.what();
      conflicts.push_back({{entry.name}, message.substr(entry.name.size() + 2)});
    }
  }
  return conflicts;
}

std::vector<Conflict> find_conflicts(const Parameters& parameters, TruthAccess truth) {
  Parameters copy = parameters;
  Conflicts conflicts = find_range_conflicts(ParameterTable(copy));
  check_input(parameters, conflicts);
  check_calibration(parameters, conflicts);
  check_frontend(parameters, conflicts);
  check_displacement(parameters, conflicts);
  check_spatial(parameters, conflicts);
  check_lines(parameters, conflicts);
  check_images(parameters, conflicts);
  check_association(parameters, conflicts);
  check_filter(parameters, truth, conflicts);
  check_policies(parameters, conflicts);
  check_map(parameters, conflicts);
  return conflicts;
}

void throw_first(const std::vector<Conflict>& conflicts, const ParameterTable& table,
                 const ParameterPlaces& places) {
  if (conflicts.empty()) {
    return;
  }
  const Conflict& first = conflicts.front();
  const auto entries = list_parameters(table);
  std::string place, names;
  for (const std::string& key : first.keys) {
    const auto known = places.find(key);
    if (place.empty() && known != places.end()) {
      place = known->second + ": ";
    }
    const auto entry = std::ranges::find(entries, key, &ParameterEntry::name);
    names += (names.empty() ? "" : " with ") + key + " = " + entry->value;
  }
  throw ConfigError(place + names + ": " + first.reason);
}

void validate(const Parameters& parameters, const ParameterPlaces& places, TruthAccess truth) {
  Parameters copy = parameters;
  throw_first(find_conflicts(parameters, truth), ParameterTable(copy), places);
}

}  // namespace libslam
