#include <bit>
#include <cmath>
#include <cstdint>
#include <stdlib.h>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/config/yaml_loader.hpp>

namespace libslam {
namespace {

// The same cases in every run; RC_PARAMS of the environment takes precedence.
[[maybe_unused]] const int kSeeded = setenv("RC_PARAMS", "seed=20060105 max_success=300", 0);

using Value = std::variant<bool, int, std::uint64_t, std::string>;

/// The raw values of all fields; reals by their bits, so that -0.0 and 0.0 differ.
class FieldCollector {
 public:
  void value(std::string_view, bool& field, const Describe&) { values.emplace_back(field); }
  void value(std::string_view, int& field, const Describe&) { values.emplace_back(field); }
  void value(std::string_view, double& field, const Describe&) {
    values.emplace_back(std::bit_cast<std::uint64_t>(field));
  }
  void value(std::string_view, std::string& field, const Describe&) { values.emplace_back(field); }
  void section(std::string_view, auto& section) { section.describe(*this); }

  std::vector<Value> values;
};

std::vector<Value> fields_of(Parameters parameters) {
  FieldCollector collector;
  parameters.describe(collector);
  return collector.values;
}

/// Fills every field with an arbitrary value of its domain.
class FieldGenerator {
 public:
  void value(std::string_view, bool& field, const Describe&) {
    field = *rc::gen::arbitrary<bool>();
  }
  void value(std::string_view, int& field, const Describe& d) {
    field = *rc::gen::inRange(std::isfinite(d.min) ? static_cast<int>(d.min) : -1'000'000,
                              std::isfinite(d.max) ? static_cast<int>(d.max) + 1 : 1'000'000);
  }
  void value(std::string_view, double& field, const Describe& d) {
    // Arbitrary bits reach every exponent; what falls outside the domain is folded into it.
    const auto bits = *rc::gen::arbitrary<std::uint64_t>();
    field = std::bit_cast<double>(bits);
    if (!std::isfinite(field) || field < d.min || field > d.max) {
      const double fraction = std::ldexp(static_cast<double>(bits >> 11U), -53);
      const double lowest = std::isfinite(d.min) ? d.min : -10.0;
      const double highest = std::isfinite(d.max) ? d.max : lowest + 10.0;
      field = lowest + fraction * (highest - lowest);
    }
  }
  void value(std::string_view, std::string& field, const Describe& d) {
    if (!d.choices.empty()) {
      field = *rc::gen::elementOf(d.choices);
      return;
    }
    field.clear();
    const auto pieces = *rc::gen::container<std::vector<std::string>>(rc::gen::element<std::string>(
        "a", "LASER", " ", "#", " # ", ": ", "\"", "'", "\\", "~", "null", "true", "1", "-", "[",
        "{", "&", "*", "%", "@", "é", "日本", "\xF0\x9F\xA4\x96"));
    for (const std::string& piece : pieces) {
      field += piece;
    }
  }
  void section(std::string_view, auto& section) { section.describe(*this); }
};

RC_GTEST_PROP(EffectiveConfiguration, ReadsBackExactly, ()) {
  Parameters parameters;
  FieldGenerator generator;
  parameters.describe(generator);
  const std::string yaml = to_yaml(parameters);
  RC_ASSERT(fields_of(load_yaml_text(yaml, "effective")) == fields_of(parameters));
  RC_ASSERT(to_yaml(load_yaml_text(yaml, "effective")) == yaml);
}

TEST(EffectiveConfiguration, HoldsEveryFieldOnce) {
  ParameterPlaces places;
  const Parameters loaded = load_yaml_text(to_yaml({}), "effective", &places);
  EXPECT_EQ(places.size(), fields_of({}).size());
  EXPECT_EQ(fields_of(loaded), fields_of({}));
}

TEST(EffectiveConfiguration, ReadsLikeAPersonWouldWriteIt) {
  const std::string yaml = to_yaml({});
  for (const char* line :
       {"motion:\n",
        " (one of odometry_increment, differential, ackermann, body_twist, constant_twist)\n"
        "  model: odometry_increment\n",
        "  track_width: 0.5\n", "  noise:\n    # ", "    from_log: true\n",
        "  max_range: 1000000\n", "  sensor_label: \"\"\n", "    prior_sigma: 0.1\n"}) {
    EXPECT_NE(yaml.find(line), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace libslam
