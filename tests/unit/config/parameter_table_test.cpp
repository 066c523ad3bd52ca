#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include <libslam/config/edit_distance.hpp>
#include <libslam/config/parameter_table.hpp>

#include "support/config_error_message.hpp"

namespace libslam {
namespace {

using test::config_error_message;

TEST(EditDistance, CountsSlipsOfTheKeyboard) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("model", "modle"), 1U);  // swapped neighbours are one slip
  EXPECT_EQ(edit_distance("ca", "abc"), 3U);       // of optimal string alignment, not Damerau
}

TEST(ParameterTable, NamesAreUniqueAndDescribed) {
  std::set<std::string> names;
  for (const ParameterEntry& entry : list_parameters({})) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_FALSE(entry.description.text.empty()) << entry.name;
    EXPECT_TRUE(entry.description.text.ends_with('.')) << entry.name;
    EXPECT_EQ(std::string(entry.section()) + "." + std::string(entry.key()), entry.name);
  }
  EXPECT_TRUE(names.contains("motion.noise.along_per_sqrt_m"));
  EXPECT_GT(names.size(), 60U);
}

TEST(ParameterTable, DefaultsAreInTheirOwnDomain) {
  Parameters parameters;
  for (const ParameterEntry& entry : list_parameters({})) {
    EXPECT_NO_THROW(assign_parameter(parameters, entry.name, entry.value)) << entry.name;
  }
}

TEST(ParameterTable, AssignsEveryType) {
  Parameters p;
  assign_parameter(p, "calibration.scale_left.enabled", "true");
  assign_parameter(p, "policies.update_every_n", "+3");
  assign_parameter(p, "motion.noise.turn_per_sqrt_m", "2.5e-2");
  assign_parameter(p, "input.sensor_label", "LASER 1");
  assign_parameter(p, "motion.model", "ackermann");
  EXPECT_TRUE(p.calibration.scale_left.enabled);
  EXPECT_EQ(p.policies.update_every_n, 3);
  EXPECT_EQ(p.motion.noise.turn_per_sqrt_m, 0.025);
  EXPECT_EQ(p.input.sensor_label, "LASER 1");
  EXPECT_EQ(p.motion.model, "ackermann");
}

struct BadValue {
  const char* name;
  const char* value;
  const char* expected;  ///< part of the message
};

class ParameterTableRejects : public testing::TestWithParam<BadValue> {};

TEST_P(ParameterTableRejects, AndSaysWhy) {
  Parameters p;
  const auto before = list_parameters(p);
  const std::string message =
      config_error_message([&] { assign_parameter(p, GetParam().name, GetParam().value); });
  EXPECT_NE(message.find(GetParam().expected), std::string::npos) << message;
  EXPECT_NE(message.find(GetParam().name), std::string::npos) << message;
  const auto after = list_parameters(p);
  EXPECT_TRUE(
      std::ranges::equal(before, after, {}, &ParameterEntry::value, &ParameterEntry::value));
}

INSTANTIATE_TEST_SUITE_P(
    Values, ParameterTableRejects,
    testing::Values(
        BadValue{"motion.track_width", "wide", "'wide' is not a finite number >= 1e-06 [m]"},
        BadValue{"motion.track_width", "", "'' is not a finite number"},
        BadValue{"motion.track_width", "0.5m", "'0.5m'"},
        BadValue{"motion.track_width", " 0.5", "' 0.5'"},
        BadValue{"motion.track_width", "0,5", "'0,5'"},
        BadValue{"motion.track_width", "-1", ">= 1e-06"},
        BadValue{"motion.track_width", "nan", "finite"},
        BadValue{"motion.track_width", "inf", "finite"},
        BadValue{"motion.track_width", "1e999", "finite"},
        BadValue{"motion.track_width", "+-1", "'+-1'"},
        BadValue{"association.gate_probability", "1.01", ">= 0 and <= 1"},
        BadValue{"policies.update_every_n", "2.0", "an integer >= 1"},
        BadValue{"policies.update_every_n", "99999999999", "an integer"},
        BadValue{"policies.update_every_n", "0", ">= 1"},
        BadValue{"output.report", "yes", "true or false"},
        BadValue{"output.report", "True", "true or false"},
        BadValue{"motion.model", "diferential", "nearest: differential"},
        BadValue{"motion.model", "", "one of odometry_increment, differential, ackermann"},
        BadValue{"input.sensor_label", "a\nb", "not one line of text"}));

TEST(ParameterTable, FindsTheNearestName) {
  Parameters p;
  const ParameterTable table(p);
  EXPECT_EQ(find_nearest_name(table, "motion.trak_width"), "motion.track_width");
  EXPECT_EQ(find_nearest_name(table, "track_width"), "motion.track_width");
  EXPECT_EQ(find_nearest_name(table, "motion.sigma_range"), "measurement.sigma_range");
  EXPECT_EQ(find_nearest_name(table, "calibration.scale_left.enable"),
            "calibration.scale_left.enabled");
  EXPECT_EQ(find_nearest_name(table, "calibration.bias_steering.enable"),
            "calibration.bias_steering.enabled");
  EXPECT_EQ(find_nearest_name(table, "mesurement"), "measurement");
}

}  // namespace
}  // namespace libslam
