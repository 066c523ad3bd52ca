#pragma once
// A struct of parameters as one flat table: what loaders check against and what help prints.

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <libslam/config/description.hpp>
#include <libslam/config/parameters.hpp>

namespace libslam {

/// References to every field of a struct that describes itself (description.hpp). Lives no longer
/// than the struct.
class ParameterTable {
 public:
  struct Field {
    std::string name;  ///< with its sections: "motion.noise.from_log"
    std::variant<bool*, int*, double*, std::string*> value;
    Describe description;
  };

  /// `parameters`: Parameters, a scenario, a campaign ...
  template <class P>
  requires(!std::is_same_v<std::remove_const_t<P>, ParameterTable>) explicit ParameterTable(
      P& parameters) {
    parameters.describe(*this);
  }

  /// In the order of their definition, sections contiguous.
  const std::vector<Field>& fields() const { return fields_; }
  /// The names of all sections, "motion" and "motion.noise" among them.
  const std::vector<std::string>& sections() const { return sections_; }

  // What `describe` calls.
  void value(std::string_view name, auto& field, Describe description) {
    fields_.push_back({prefix_ + std::string(name), &field, std::move(description)});
  }
  void section(std::string_view name, auto& section) {
    const std::string outer = prefix_;
    sections_.push_back(prefix_ + std::string(name));
    prefix_ = sections_.back() + ".";
    section.describe(*this);
    prefix_ = outer;
  }

 private:
  std::vector<Field> fields_;
  std::vector<std::string> sections_;
  std::string prefix_;
};

enum class ParameterType { kBool, kInteger, kReal, kText };

/// One parameter with its value and everything the description says about it.
struct ParameterEntry {
  std::string name;  ///< with its sections: "motion.noise.from_log"
  ParameterType type = ParameterType::kText;
  std::string value;  ///< as `assign_parameter` reads it back; reals round-trip exactly
  Describe description;

  std::string_view section() const;  ///< "motion.noise"; empty at the root
  std::string_view key() const;      ///< "from_log"
};

/// All parameters with their values, in the order of the table.
std::vector<ParameterEntry> list_parameters(const ParameterTable& table);
std::vector<ParameterEntry> list_parameters(const Parameters& parameters);

/// Sets the parameter called `name` from its text form.
/// Throws ConfigError (without a place) and changes nothing if there is no such parameter, or the
/// value is of the wrong type, not finite, out of range or none of the choices.
void assign_parameter(const ParameterTable& table, std::string_view name, std::string_view value);
void assign_parameter(Parameters& parameters, std::string_view name, std::string_view value);

/// The parameter or section whose name is nearest to a misspelled one. The place counts less than
/// the word: "trak_width" finds "motion.track_width".
std::string find_nearest_name(const ParameterTable& table, std::string_view name);

/// "a number >= 0 [m]", "one of left, right" ...: what a value of `entry` must be.
std::string describe_domain(const ParameterEntry& entry);

}  // namespace libslam
