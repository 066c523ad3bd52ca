#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <tuple>

#include <libslam/config/config_error.hpp>
#include <libslam/config/edit_distance.hpp>
#include <libslam/config/parameter_table.hpp>
#include <libslam/config/text_file.hpp>

namespace libslam {
namespace {

std::string write_real(double value) {
  // Exponents only where they are shorter than the zeros; either form is the shortest that reads
  // back as the same double.
  const double size = std::abs(value);
  const bool is_plain = size == 0.0 || (size >= 1e-4 && size < 1e12);
  std::array<char, 64> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value,
                    is_plain ? std::chars_format::fixed : std::chars_format::scientific);
  return {text.data(), end.ptr};
}

std::string write_value(bool value) {
  return value ? "true" : "false";
}
std::string write_value(int value) {
  return std::to_string(value);
}
std::string write_value(double value) {
  return write_real(value);
}
std::string write_value(const std::string& value) {
  return value;
}

ParameterEntry entry_of(const ParameterTable::Field& field) {
  // The alternatives of the variant stand in the order of ParameterType.
  return {field.name, static_cast<ParameterType>(field.value.index()),
          std::visit([](const auto* value) { return write_value(*value); }, field.value),
          field.description};
}

// Names and values beyond any sensible length are compared by their beginning, which bounds the
// work.
constexpr std::size_t kLongestCompared = 100;

[[noreturn]] void reject(const ParameterEntry& entry, std::string_view value) {
  std::string message =
      entry.name + ": " + quote_for_message(value) + " is not " + describe_domain(entry);
  const auto& choices = entry.description.choices;
  if (!choices.empty()) {
    message += "; nearest: ";
    message += *std::ranges::min_element(choices, {}, [&](std::string_view choice) {
      return edit_distance(value.substr(0, kLongestCompared), choice);
    });
  }
  throw ConfigError(message);
}

bool parse(std::string_view text, bool& value) {
  value = text == "true";
  return value || text == "false";
}

template <typename Number>
bool parse_number(std::string_view text, Number& value) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) {
      return false;
    }
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

bool parse(std::string_view text, int& value) {
  return parse_number(text, value);
}
bool parse(std::string_view text, double& value) {
  return parse_number(text, value) && std::isfinite(value);
}
bool parse(std::string_view text, std::string& value) {
  value = text;
  // Control characters would not survive the effective configuration file.
  return std::ranges::none_of(text, [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7F;
  });
}

template <typename T>
bool is_in_domain(const T& value, const Describe& description) {
  if constexpr (std::same_as<T, std::string>) {
    return description.choices.empty() ||
           std::ranges::find(description.choices, value) != description.choices.end();
  } else if constexpr (std::same_as<T, bool>) {
    return true;
  } else {
    return value >= description.min && value <= description.max;
  }
}

template <typename T>
void assign(const ParameterTable::Field& field, T* target, std::string_view text) {
  T parsed{};
  if (!parse(text, parsed) || !is_in_domain(parsed, field.description)) {
    reject(entry_of(field), text);
  }
  *target = parsed;
}

std::string_view last_word(std::string_view name) {
  return name.substr(name.rfind('.') + 1);
}

}  // namespace

std::string_view ParameterEntry::section() const {
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos ? std::string_view() : std::string_view(name).substr(0, dot);
}

std::string_view ParameterEntry::key() const {
  return last_word(name);
}

std::vector<ParameterEntry> list_parameters(const ParameterTable& table) {
  std::vector<ParameterEntry> entries;
  for (const ParameterTable::Field& field : table.fields()) {
    entries.push_back(entry_of(field));
  }
  return entries;
}

std::vector<ParameterEntry> list_parameters(const Parameters& parameters) {
  Parameters copy = parameters;  // `describe` serves readers and writers alike, so it is not const
  return list_parameters(ParameterTable(copy));
}

void assign_parameter(const ParameterTable& table, std::string_view name, std::string_view value) {
  const auto& fields = table.fields();
  const auto field = std::ranges::find(fields, name, &ParameterTable::Field::name);
  if (field != fields.end()) {
    std::visit([&](auto* target) { assign(*field, target, value); }, field->value);
  } else if (std::ranges::find(table.sections(), name) != table.sections().end()) {
    throw ConfigError(std::string(name) + ": is a section, set one of its keys");
  } else {
    throw ConfigError("unknown key " + quote_for_message(name) +
                      "; nearest valid key: " + find_nearest_name(table, name));
  }
}

void assign_parameter(Parameters& parameters, std::string_view name, std::string_view value) {
  assign_parameter(ParameterTable(parameters), name, value);
}

std::string find_nearest_name(const ParameterTable& table, std::string_view name) {
  // Names are compared by their last word first; the whole name decides between equal words.
  name = name.substr(0, kLongestCompared);
  std::vector<std::string> candidates = table.sections();
  for (const ParameterTable::Field& field : table.fields()) {
    candidates.push_back(field.name);
  }
  return *std::ranges::min_element(candidates, {}, [&](const std::string& candidate) {
    return std::tuple(edit_distance(last_word(name), last_word(candidate)),
                      edit_distance(name, candidate));
  });
}

std::string describe_domain(const ParameterEntry& entry) {
  const Describe& d = entry.description;
  if (entry.type == ParameterType::kBool) {
    return "true or false";
  }
  if (entry.type == ParameterType::kText) {
    if (d.choices.empty()) {
      return "one line of text";
    }
    std::string list = "one of ";
    for (const std::string_view& choice : d.choices) {
      list += (&choice == &d.choices.front() ? "" : ", ") + std::string(choice);
    }
    return list;
  }
  std::string domain = entry.type == ParameterType::kInteger ? "an integer" : "a finite number";
  if (std::isfinite(d.min)) {
    domain += " >= " + write_real(d.min);
  }
  if (std::isfinite(d.max)) {
    domain += (std::isfinite(d.min) ? " and <= " : " <= ") + write_real(d.max);
  }
  return d.unit.empty() || d.unit == "1" ? domain : domain + " [" + std::string(d.unit) + "]";
}

}  // namespace libslam
