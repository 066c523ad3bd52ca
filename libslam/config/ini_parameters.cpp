#include <algorithm>
#include <array>
#include <ostream>
#include <set>
#include <vector>

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/system/string_utils.h>

#include <libslam/config/config_error.hpp>
#include <libslam/config/ini_parameters.hpp>
#include <libslam/config/parameter_table.hpp>

namespace libslam {

namespace {

constexpr std::string_view kPrefix = "libslam.";

struct ShortName {
  std::string_view name, section;
};
constexpr auto kShortNames = std::to_array<ShortName>({
    {"calibration", "calibration"},
    {"adaptation", "policies.noise_adaptation"},
    {"disturbance", "policies.disturbance"},
});

struct Counterpart {
  std::string_view parameter, option;
};
constexpr auto kCounterparts = std::to_array<Counterpart>({
    {"measurement.sigma_range", "std_sensor_range"},
    {"measurement.sigma_bearing_deg", "std_sensor_yaw_deg"},
    {"motion.no_odometry_sigma_xy", "stds_Q_no_odo"},
    {"motion.no_odometry_sigma_heading_deg", "stds_Q_no_odo"},
    {"association.gate_probability", "data_assoc_IC_chi2_thres"},
});

/// The section of parameters that a section of the file speaks about.
std::optional<std::string> section_of(const std::string& section) {
  if (section.starts_with(kPrefix)) return section.substr(kPrefix.size());
  for (const ShortName& known : kShortNames) {
    if (section == known.name) return std::string(known.section);
    if (section.starts_with(known.name) && section[known.name.size()] == '.')
      return std::string(known.section) + section.substr(known.name.size());
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> kf_slam_option(std::string_view parameter) {
  const auto* const found = std::ranges::find(kCounterparts, parameter, &Counterpart::parameter);
  if (found == kCounterparts.end()) return std::nullopt;
  return "MRPT's option " + std::string(found->option) + "; set it in [RangeBearingKFSLAM]";
}

std::string place_in_ini(const std::string& section, const std::string& key) {
  return std::string("[").append(section).append("] ").append(key).append(": ");
}

bool is_parameter_section(const std::string& section) {
  return section_of(section).has_value();
}

void load_parameters(const mrpt::config::CConfigFileBase& source, Parameters& parameters,
                     const ReservedParameter& reserved) {
  std::vector<std::string> sections, keys;
  std::set<std::string> seen;
  source.getAllSections(sections);
  for (const std::string& section : sections) {
    const std::optional<std::string> meant = section_of(section);
    if (!meant) continue;
    source.getAllKeys(section, keys);
    for (const std::string& key : keys) {
      const std::string name = *meant + "." + key;
      const std::string value = mrpt::system::trim(source.read_string(section, key, ""));
      try {
        if (const auto owner = reserved ? reserved(name) : std::nullopt)
          throw ConfigError("is " + *owner);
        if (!seen.insert(name).second) throw ConfigError("is set under another name as well");
        assign_parameter(parameters, name, value);
      } catch (const ConfigError& error) {
        throw ConfigError(place_in_ini(section, key) + error.what());
      }
    }
  }
}

void dump_parameters(std::ostream& out, const Parameters& parameters,
                     const ReservedParameter& reserved) {
  for (const ParameterEntry& entry : list_parameters(parameters))
    if (!reserved || !reserved(entry.name))
      out << kPrefix << entry.name << " = " << entry.value << '\n';
}

}  // namespace libslam
