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
  DocumentLoader(const ParameterTable& table, const std::string& file_name, ParameterPlaces* places)
      : table_(table), file_name_(file_name), places_(places) {}

  void load(const YamlNode& mapping, const std::string& section) const {
    for (const YamlEntry& entry : mapping.entries) {
      const std::string name = section.empty() ? entry.key : section + "." + entry.key;
      if (std::ranges::find(table_.sections(), name) != table_.sections().end()) {
        load_section(entry, name);
      } else {
        load_parameter(entry, name);
      }
    }
  }

 private:
  [[noreturn]] void fail(FilePlace place, const std::string& message) const {
    throw ConfigError(describe_place(file_name_, place) + ": " + message);
  }

  void load_section(const YamlEntry& entry, const std::string& name) const {
    if (entry.value.is_null()) {
      return;  // a section whose keys are all commented out
    }
    if (entry.value.kind != YamlNode::Kind::kMapping) {
      fail(entry.value.place, name + ": is a section, indented `key: value` lines are expected");
    }
    load(entry.value, name);
  }

  void load_parameter(const YamlEntry& entry, const std::string& name) const {
    const auto known = std::ranges::find(entries_, name, &ParameterEntry::name);
    if (known == entries_.end()) {
      fail(entry.place, "unknown key " + quote_for_message(name) +
                            "; nearest valid key: " + find_nearest_name(table_, name));
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
      assign_parameter(table_, name, value.text);
    } catch (const ConfigError& error) {
      fail(value.place, error.what());
    }
    if (places_ != nullptr) {
      (*places_)[name] = describe_place(file_name_, entry.place);
    }
  }

  const ParameterTable& table_;
  const std::string& file_name_;
  ParameterPlaces* places_;
  std::vector<ParameterEntry> entries_ = list_parameters(table_);
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

void load_yaml(const ParameterTable& table, const YamlNode& mapping, const std::string& file_name,
               ParameterPlaces* places) {
  DocumentLoader(table, file_name, places).load(mapping, "");
}

void load_yaml(const ParameterTable& table, const std::filesystem::path& path,
               ParameterPlaces* places) {
  load_yaml(table, parse_yaml(read_config_text(path), path.string()), path.string(), places);
}

Parameters load_yaml(const std::filesystem::path& path, ParameterPlaces* places) {
  return load_yaml_text(read_config_text(path), path.string(), places);
}

Parameters load_yaml_text(std::string_view text, const std::string& file_name,
                          ParameterPlaces* places) {
  Parameters parameters;
  load_yaml(ParameterTable(parameters), parse_yaml(text, file_name), file_name, places);
  return parameters;
}

void set_parameter(const ParameterTable& table, std::string_view assignment,
                   ParameterPlaces* places) {
  const std::string place = "--set " + quote_for_message(assignment) + ": ";
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) {
    throw ConfigError(place + "section.key=value is expected");
  }
  const std::string name(assignment.substr(0, equals));
  const std::string_view value = assignment.substr(equals + 1);
  try {
    // A text must survive the effective configuration: invalid UTF-8 of a command line would not.
    parse_yaml("value: " + quote_for_yaml(value), name);
    assign_parameter(table, name, value);
  } catch (const ConfigError& error) {
    throw ConfigError(place + error.what());
  }
  if (places != nullptr) {
    (*places)[name] = "--set";
  }
}

void set_parameter(Parameters& parameters, std::string_view assignment, ParameterPlaces* places) {
  set_parameter(ParameterTable(parameters), assignment, places);
}

std::string to_yaml(const ParameterTable& table) {
  std::string yaml;
  std::string section;
  for (const ParameterEntry& entry : list_parameters(table)) {
    const std::string next(entry.section());
    write_headings(section, next, yaml);
    section = next;
    const auto depth =
        next.empty() ? 0 : static_cast<std::size_t>(std::ranges::count(next, '.')) + 1;
    const std::string indent(2 * depth, ' ');
    yaml +=
        indent + "# " + std::string(entry.description.text) + " (" + describe_domain(entry) + ")\n";
    yaml += indent + std::string(entry.key()) + ": " + write_value(entry) + "\n";
  }
  return yaml;
}

std::string to_yaml(const Parameters& parameters) {
  Parameters copy = parameters;  // a table refers to what it could write
  return to_yaml(ParameterTable(copy));
}

}  // namespace libslam
