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

template <typename T>
constexpr ParameterType type_of() {
  if constexpr (std::same_as<T, bool>) {
    return ParameterType::kBool;
  } else if constexpr (std::same_as<T, int>) {
    return ParameterType::kInteger;
  } else if constexpr (std::same_as<T, double>) {
    return ParameterType::kReal;
  } else {
    static_assert(std::same_as<T, std::string>);
    return ParameterType::kText;
  }
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

/// Visits sections with their full names.
class SectionVisitor {
 public:
  std::string full_name(std::string_view key) const {
    return prefix_.empty() ? std::string(key) : prefix_ + "." + std::string(key);
  }

 protected:
  template <typename Visitor, typename Section>
  void descend(Visitor& visitor, std::string_view name, Section& section) {
    const std::string outer = prefix_;
    prefix_ = full_name(name);
    section.describe(visitor);
    prefix_ = outer;
  }

 private:
  std::string prefix_;
};

class Lister : public SectionVisitor {
 public:
  template <typename T>
  void value(std::string_view name, T& field, const Describe& description) {
    entries.push_back({full_name(name), type_of<T>(), write_value(field), description});
  }
  template <typename Section>
  void section(std::string_view name, Section& section) {
    sections.push_back(full_name(name));
    descend(*this, name, section);
  }

  std::vector<ParameterEntry> entries;
  std::vector<std::string> sections;
};

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

class Assigner : public SectionVisitor {
 public:
  Assigner(std::string_view name, std::string_view text) : name_(name), text_(text) {}

  template <typename T>
  void value(std::string_view name, T& field, const Describe& description) {
    if (found || full_name(name) != name_) {
      return;
    }
    found = true;
    T parsed{};
    if (!parse(text_, parsed) || !is_in_domain(parsed, description)) {
      reject({full_name(name), type_of<T>(), {}, description}, text_);
    }
    field = parsed;
  }
  template <typename Section>
  void section(std::string_view name, Section& section) {
    is_section = is_section || full_name(name) == name_;
    descend(*this, name, section);
  }

  bool found = false, is_section = false;

 private:
  std::string_view name_, text_;
};

std::string_view last_word(std::string_view name) {
  return name.substr(name.rfind('.') + 1);
}

}  // namespace

std::string_view ParameterEntry::section() const {
  return std::string_view(name).substr(0, name.rfind('.'));
}

std::string_view ParameterEntry::key() const {
  return last_word(name);
}

std::vector<ParameterEntry> list_parameters(const Parameters& parameters) {
  Parameters copy = parameters;  // `describe` serves readers and writers alike, so it is not const
  Lister lister;
  copy.describe(lister);
  return std::move(lister.entries);
}

std::vector<std::string> list_sections() {
  Parameters defaults;
  Lister lister;
  defaults.describe(lister);
  return std::move(lister.sections);
}

void assign_parameter(Parameters& parameters, std::string_view name, std::string_view value) {
  Assigner assigner(name, value);
  parameters.describe(assigner);
  if (assigner.is_section) {
    throw ConfigError(std::string(name) + ": is a section, set one of its keys");
  }
  if (!assigner.found) {
    throw ConfigError("unknown key " + quote_for_message(name) +
                      "; nearest valid key: " + find_nearest_name(name));
  }
}

std::string find_nearest_name(std::string_view name) {
  // Names are compared by their last word first; the whole name decides between equal words.
  name = name.substr(0, kLongestCompared);
  std::vector<std::string> candidates = list_sections();
  for (const ParameterEntry& entry : list_parameters({})) {
    candidates.push_back(entry.name);
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
