#include <ostream>

#include <mrpt/config/CConfigFileBase.h>

#include <libslam/config/config_error.hpp>
#include <libslam/config/ini_parameters.hpp>
#include <libslam/config/parameter_table.hpp>
#include <libslam/modules/stereo_localization.hpp>

namespace libslam {

StereoLocalization::TOptions::TOptions() {
  parameters.input.odometry = "twist";
  parameters.motion.model = "body_twist";
  parameters.frontend.source = "stereo_points";
  parameters.measurement.model = "stereo_point";
  parameters.association.method = "known_or_nearest";
  parameters.map.start = "given_pose";
}

void StereoLocalization::TOptions::loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                                                      const std::string& section) {
  const auto copy = [&](const char* key, const char* name) {
    if (!source.keyExists(section, key)) return;
    try {
      assign_parameter(parameters, name, source.read_string(section, key, ""));
    } catch (const ConfigError& error) {
      throw ConfigError(place_in_ini(section, key) + error.what());
    }
  };
  copy("map_file", "map.file");
  copy("map_sigma", "map.sigma");
  const bool grows = parameters.map.mode == "continue";
  parameters.map.mode = source.read_bool(section, "add_landmarks", grows) ? "continue" : "localize";
  load_parameters(source, parameters);
}

void StereoLocalization::TOptions::dumpToTextStream(std::ostream& out) const {
  out << "\n----------- [StereoLocalization::TOptions] ------------ \n\n";
  dump_parameters(out, parameters);
}

void StereoLocalization::loadOptions(const mrpt::config::CConfigFileBase& ini,
                                     const std::string& section) {
  options.loadFromConfigFile(ini, section);
  setMinLoggingLevel(ini.read_enum<mrpt::system::VerbosityLevel>(section, "verbosity_level",
                                                                 getMinLoggingLevel()));
}

}  // namespace libslam
