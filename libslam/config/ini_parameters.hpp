#pragma once
// Our parameters in the ini files of MRPT programs.
//
// A section [libslam.X] holds the keys of section X of config/README.md:
//   [libslam.filter] error_frame = right_invariant
// What a program tunes most has short names:
//   [calibration.scale_left] enabled = true      for [libslam.calibration.scale_left]
//   [adaptation] ...                             for [libslam.policies.noise_adaptation]
//   [disturbance] ...                            for [libslam.policies.disturbance]
// A key may also carry the rest of its name: [calibration] scale_left.enabled = true.

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include <libslam/config/parameters.hpp>

namespace mrpt::config {
class CConfigFileBase;
}

namespace libslam {

/// The place in an ini file where a parameter belongs that must not be set by its own name, such as
/// "MRPT's option std_sensor_range; set it in [RangeBearingKFSLAM]"; nothing if it may.
using ReservedParameter = std::function<std::optional<std::string>(std::string_view name)>;

/// True for the sections above.
bool is_parameter_section(const std::string& section);

/// Writes what the sections above say over `parameters`; other sections are not read. Throws
/// ConfigError naming section and key on a key that is unknown, has a bad value, stands under both
/// names of its section, or is reserved.
void load_parameters(const mrpt::config::CConfigFileBase& source, Parameters& parameters,
                     const ReservedParameter& reserved = {});

/// One line "libslam.section.key = value" for each parameter that is not reserved.
void dump_parameters(std::ostream& out, const Parameters& parameters,
                     const ReservedParameter& reserved = {});

/// The reserved parameters of MRPT's kf-slam files: those that one of its own options holds.
std::optional<std::string> kf_slam_option(std::string_view parameter);

/// "[section] key: ", which begins every message about an ini file.
std::string place_in_ini(const std::string& section, const std::string& key);

}  // namespace libslam
