#include <algorithm>
#include <vector>

#include <libslam/config/parameter_table.hpp>
#include <libslam/config/text_file.hpp>
#include <libslam/config/yaml_document.hpp>
#include <libslam/config/yaml_loader.hpp>

namespace libslam {
namespace {

/// Applies a parsed document to parameters, in file order.
class DocumentLoader {
 public:
  DocumentLoader(const std::string& file_name, ParameterPlaces* places)
      : file_name_(file_name), places_(places), sections_(list_sections()) {}

  void load(const YamlNode& mapping, const std::string& section, Parameters& parameters) const {
    for (const YamlEntry& entry : mapping.entries) {
      const std::string name = section.empty() ? entry.key : section + "." + entry.key;
      if (std::ranges::find(sections_, name) != sections_.end()) {
        load_section(entry, name, parameters);
      } else {
        load_parameter(entry, name, parameters);
      }
    }
  }

 private:
  [[noreturn]] void fail(FilePlace place, const std::string& message) const {
    throw ConfigError(describe_place(file_name_, place) + ": " + message);
  }

  void load_section(const YamlEntry& entry, const std::string& name, Parameters& parameters) const {
    if (entry.value.is_null()) {
      return;  // a section whose keys are all commented out
    }
    if (entry.value.kind != YamlNode::Kind::kMapping) {
      fail(entry.value.place, name + ": is a section, indented `key: value` lines are expected");
    }
    load(entry.value, name, parameters);
  }

  void load_parameter(const YamlEntry& entry, const std::string& name,
                      Parameters& parameters) const {
    const auto known = std::ranges::find(entries_, name, &ParameterEntry::name);
    if (known == entries_.end()) {
      fail(entry.place, "unknown key " + quote_for_message(name) +
                            "; nearest valid key: " + find_nearest_name(name));
    }
    const YamlNode& value = entry.value;
    if (value.kind != YamlNode::Kind::kScalar) {
      fail(value.place, name + ": a single value is expected, " + describe_domain(*known));
    }
    if (value.is_null()) {
      fail(value.place, name + ": has no value, expected is " + describe_domain(*known));
    }
    if (value.quoted && known->type != ParameterType::kText) {
      fail(value.place, name + ": is a text in quotes, expected is " + describe_domain(*known));
    }
    try {
      assign_parameter(parameters, name, value.text);
    } catch (const ConfigError& error) {
      fail(value.place, error.what());
    }
    if (places_ != nullptr) {
      (*places_)[name] = describe_place(file_name_, entry.place);
    }
  }

  const std::string& file_name_;
  ParameterPlaces* places_;
  std::vector<std::string> sections_;
  std::vector<ParameterEntry> entries_ = list_parameters({});
};

std::string quote_for_yaml(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
    }
    quoted += c;
  }
  return quoted + "\"";
}

std::string write_value(const ParameterEntry& entry) {
  const bool is_free_text = entry.type == ParameterType::kText && entry.description.choices.empty();
  return is_free_text ? quote_for_yaml(entry.value) : entry.value;
}

/// The section headings that lie between two neighbours of the table.
void write_headings(const std::string& from, const std::string& to, std::string& yaml) {
  std::size_t end = 0;
  for (std::string indent; end != std::string::npos; indent += "  ") {
    const std::size_t begin = end == 0 ? 0 : end + 1;
    end = to.find('.', begin);
    const std::string heading = to.substr(0, end);
    if (from == heading || from.starts_with(heading + ".")) {
      continue;
    }
    yaml += (indent.empty() && !yaml.empty() ? "\n" : "") + indent + to.substr(begin, end - begin) +
            ":\n";
  }
}

}  // namespace

Parameters load_yaml(const std::filesystem::path& path, ParameterPlaces* places) {
  return load_yaml_text(read_config_text(path), path.string(), places);
}

Parameters load_yaml_text(std::string_view text, const std::string& file_name,
                          ParameterPlaces* places) {
  Parameters parameters;
  DocumentLoader(file_name, places).load(parse_yaml(text, file_name), "", parameters);
  return parameters;
}

void set_parameter(Parameters& parameters, std::string_view assignment, ParameterPlaces* places) {
  const std::string place = "--set " + quote_for_message(assignment) + ": ";
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) {
    throw ConfigError(place + "section.key=value is expected");
  }
  const std::string name(assignment.substr(0, equals));
  const std::string_view value = assignment.substr(equals + 1);
  try {
    Parameters changed = parameters;
    assign_parameter(changed, name, value);
    // A text must survive the effective configuration: invalid UTF-8 of a command line would not.
    parse_yaml("value: " + quote_for_yaml(value), name);
    parameters = std::move(changed);
  } catch (const ConfigError& error) {
    throw ConfigError(place + error.what());
  }
  if (places != nullptr) {
    (*places)[name] = "--set";
  }
}

std::string to_yaml(const Parameters& parameters) {
  std::string yaml;
  std::string section;
  for (const ParameterEntry& entry : list_parameters(parameters)) {
    const std::string next(entry.section());
    write_headings(section, next, yaml);
    section = next;
    const auto depth = static_cast<std::size_t>(std::ranges::count(next, '.')) + 1;
    const std::string indent(2 * depth, ' ');
    yaml +=
        indent + "# " + std::string(entry.description.text) + " (" + describe_domain(entry) + ")\n";
    yaml += indent + std::string(entry.key()) + ": " + write_value(entry) + "\n";
  }
  return yaml;
}

}  // namespace libslam
