#pragma once
// The strict loader of configuration files, and their writer.

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include <libslam/config/config_error.hpp>
#include <libslam/config/parameter_table.hpp>
#include <libslam/config/yaml_document.hpp>

namespace libslam {

/// Where each parameter was set: full name -> "file:line:column" or "--set". Defaults are absent.
using ParameterPlaces = std::map<std::string, std::string>;

/// Loads a YAML file over the values in `table`.
///
/// Throws ConfigError "file:line:column: ..." on a syntax error, an unknown key (names the nearest
/// valid one), a key given twice, a wrong type, a value out of range or none of the choices, and
/// ConfigError "file: ..." if the file cannot be read. Combinations are left to `validate`.
/// `places`, if given, learns where each parameter was set.
void load_yaml(const ParameterTable& table, const std::filesystem::path& path,
               ParameterPlaces* places = nullptr);
/// The same from a part of a parsed document; `file_name` serves the messages.
void load_yaml(const ParameterTable& table, const YamlNode& mapping, const std::string& file_name,
               ParameterPlaces* places = nullptr);

/// A run, over the defaults.
Parameters load_yaml(const std::filesystem::path& path, ParameterPlaces* places = nullptr);
/// The same from a text.
Parameters load_yaml_text(std::string_view text, const std::string& file_name,
                          ParameterPlaces* places = nullptr);

/// Applies one `section.key=value` of the command line. Throws ConfigError "--set ...: ..." and
/// changes nothing where it cannot.
void set_parameter(const ParameterTable& table, std::string_view assignment,
                   ParameterPlaces* places = nullptr);
void set_parameter(Parameters& parameters, std::string_view assignment,
                   ParameterPlaces* places = nullptr);

/// The complete effective configuration as YAML, every default filled in, meaning and domain of
/// each key as a comment. Loading it again gives exactly the same values.
std::string to_yaml(const ParameterTable& table);
std::string to_yaml(const Parameters& parameters);

}  // namespace libslam
