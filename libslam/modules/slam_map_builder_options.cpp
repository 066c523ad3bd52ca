#include <ostream>

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/core/bits_math.h>

#include <libslam/config/ini_parameters.hpp>
#include <libslam/modules/slam_map_builder.hpp>

namespace libslam {

using mrpt::DEG2RAD;
using mrpt::RAD2DEG;

SlamMapBuilder::TConfigParams::TConfigParams() : insertionAngDistance(DEG2RAD(30.0)) {}

void SlamMapBuilder::TConfigParams::loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                                                       const std::string& section) {
  MRPT_LOAD_CONFIG_VAR(insertionLinDistance, double, source, section);
  MRPT_LOAD_CONFIG_VAR_DEGREES(insertionAngDistance, source, section);
  mapInitializers.loadFromConfigFile(source, section);
  load_parameters(source, parameters);
}

void SlamMapBuilder::TConfigParams::dumpToTextStream(std::ostream& out) const {
  out << "\n----------- [SlamMapBuilder::TConfigParams] ------------ \n\n";
  LOADABLEOPTS_DUMP_VAR(insertionLinDistance, double);
  LOADABLEOPTS_DUMP_VAR_DEG(insertionAngDistance);
  dump_parameters(out, parameters);
  mapInitializers.dumpToTextStream(out);
}

void SlamMapBuilder::loadOptions(const mrpt::config::CConfigFileBase& ini,
                                 const std::string& section) {
  const std::lock_guard lock(critical_);
  slam_options.loadFromConfigFile(ini, section);
  options.enableMapUpdating =
      ini.read_bool(section, "enableMapUpdating", options.enableMapUpdating);
  options.debugForceInsertion =
      ini.read_bool(section, "debugForceInsertion", options.debugForceInsertion);
  options.alwaysInsertByClass.fromString(
      ini.read_string(section, "alwaysInsertByClass", options.alwaysInsertByClass.asString()));
  setMinLoggingLevel(ini.read_enum<mrpt::system::VerbosityLevel>(section, "verbosity_level",
                                                                 getMinLoggingLevel()));
}

}  // namespace libslam
