#include <gtest/gtest.h>

#include <libslam/config/yaml_loader.hpp>

#include "support/config_error_message.hpp"
#include "support/temporary_directory.hpp"

namespace libslam {
namespace {

using test::config_error_message;

TEST(YamlLoader, KeepsDefaultsOfWhatTheFileLeavesOut) {
  const Parameters p = load_yaml_text(
      "motion:\n  model: differential\n  noise: {from_log: false, along_per_sqrt_m: 0.125}\n"
      "input:\n  sensor_label: 'it''s # one'\n",
      "c.yaml");
  EXPECT_EQ(p.motion.model, "differential");
  EXPECT_FALSE(p.motion.noise.from_log);
  EXPECT_EQ(p.motion.noise.along_per_sqrt_m, 0.125);
  EXPECT_EQ(p.input.sensor_label, "it's # one");
  EXPECT_EQ(p.motion.track_width, Parameters{}.motion.track_width);
  EXPECT_EQ(p.association.method, Parameters{}.association.method);
}

TEST(YamlLoader, TakesEmptyFilesAndEmptySections) {
  EXPECT_EQ(to_yaml(load_yaml_text("", "c")), to_yaml({}));
  EXPECT_EQ(to_yaml(load_yaml_text("# nothing\n", "c")), to_yaml({}));
  EXPECT_EQ(to_yaml(load_yaml_text("---\n", "c")), to_yaml({}));
  EXPECT_EQ(to_yaml(load_yaml_text("policies:\n  # update_every_n: 2\nmotion:\n", "c")),
            to_yaml({}));
}

TEST(YamlLoader, TakesWindowsLinesAndAByteOrderMark) {
  const Parameters p = load_yaml_text("\xEF\xBB\xBFmotion:\r\n  model: ackermann\r\n", "c");
  EXPECT_EQ(p.motion.model, "ackermann");
}

TEST(YamlLoader, RemembersWhereAParameterWasSet) {
  ParameterPlaces places;
  load_yaml_text("motion:\n  model: ackermann\n\n  wheelbase: 3\n", "c.yaml", &places);
  EXPECT_EQ(places,
            (ParameterPlaces{{"motion.model", "c.yaml:2:3"}, {"motion.wheelbase", "c.yaml:4:3"}}));
}

struct BadText {
  const char* text;
  const char* message;  ///< how the whole message begins
};

class YamlLoaderRejects : public testing::TestWithParam<BadText> {};

TEST_P(YamlLoaderRejects, WithPlaceAndReason) {
  const std::string message =
      config_error_message([] { load_yaml_text(GetParam().text, "c.yaml"); });
  EXPECT_EQ(message.rfind(GetParam().message, 0), 0U) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Meaning, YamlLoaderRejects,
    testing::Values(
        BadText{"motion:\n  modle: ackermann\n",
                "c.yaml:2:3: unknown key 'motion.modle'; nearest valid key: motion.model"},
        BadText{"moton:\n  model: ackermann\n",
                "c.yaml:1:1: unknown key 'moton'; nearest valid key: motion"},
        BadText{
            "sigma_range: 1\n",
            "c.yaml:1:1: unknown key 'sigma_range'; nearest valid key: measurement.sigma_range"},
        BadText{"motion:\n  track_width: narrow\n",
                "c.yaml:2:16: motion.track_width: 'narrow' is not a finite number >= 1e-06 [m]"},
        BadText{"motion:\n  track_width: \"0.5\"\n",
                "c.yaml:2:16: motion.track_width: is a text in quotes"},
        BadText{"motion:\n  track_width:\n", "c.yaml:2:15: motion.track_width: has no value"},
        BadText{"motion:\n  track_width: ~\n", "c.yaml:2:16: motion.track_width: has no value"},
        BadText{"motion:\n  track_width: [1, 2]\n",
                "c.yaml:2:16: motion.track_width: a single value is expected"},
        BadText{"motion:\n  model:\n    name: ackermann\n",
                "c.yaml:3:5: motion.model: a single value is expected"},
        BadText{"motion: ackermann\n", "c.yaml:1:9: motion: is a section"},
        BadText{"motion: [model]\n", "c.yaml:1:9: motion: is a section"},
        BadText{"output:\n  report: yes\n",
                "c.yaml:2:11: output.report: 'yes' is not true or false"},
        BadText{
            "association: {gate_probability: 2}\n",
            "c.yaml:1:33: association.gate_probability: '2' is not a finite number >= 0 and <= 1"},
        BadText{"motion:\n  model: diferential\n",
                "c.yaml:2:10: motion.model: 'diferential' is not one of odometry_increment, "
                "differential, ackermann, body_twist, constant_twist; nearest: differential"}));

INSTANTIATE_TEST_SUITE_P(
    Syntax, YamlLoaderRejects,
    testing::Values(
        BadText{"motion:\n  model: ackermann\n  model: differential\n",
                "c.yaml:3:3: key 'model' is given twice, first in line 2"},
        BadText{"motion:\n  wheelbase: 1\ninput:\nmotion:\n  model: ackermann\n",
                "c.yaml:4:1: key 'motion' is given twice, first in line 1"},
        BadText{"motion: {model: ackermann, model: ackermann}\n",
                "c.yaml:1:28: key 'model' is given"},
        BadText{"motion:\n  model: [a, b\ninput: 3\n", "c.yaml:3:6: not valid YAML: "},
        BadText{"motion: 1 input: 2\n", "c.yaml:1:16: not valid YAML: "},
        BadText{"motion:\n  model: \"open\n", "c.yaml:3:1: not valid YAML: "},
        BadText{"motion:\n\tmodel: ackermann\n", "c.yaml:2:1: not valid YAML: "},
        BadText{"motion:\n   model: a\n  wheelbase: 2\n", "c.yaml:3:3: not valid YAML: "},
        BadText{"motion: @x\n", "c.yaml:1:9: not valid YAML: "},
        BadText{"motion:\n  model: ackermann\n---\nmotion:\n", "c.yaml:3:1: a second document"},
        BadText{"motion: &x\n  wheelbase: 1\ninput: *x\n", "c.yaml:3:8: aliases (*name) are not"},
        BadText{"input: *x\n", "c.yaml:1:8: aliases (*name) are not"},
        BadText{"? [1, 2]\n: 3\n", "c.yaml:1:3: a key must be plain text"},
        BadText{"- motion\n", "c.yaml:1:1: a mapping of sections is expected"},
        BadText{"motion\n", "c.yaml:1:1: a mapping of sections is expected"},
        BadText{"motion:1\n", "c.yaml:1:1: a mapping of sections is expected"}));

TEST(YamlLoader, NamesTheFileItCannotRead) {
  const test::TemporaryDirectory directory;
  const std::filesystem::path absent = directory.path() / "absent.yaml";
  EXPECT_EQ(config_error_message([&] { load_yaml(absent); }), absent.string() + ": no such file");
  EXPECT_EQ(config_error_message([&] { load_yaml(directory.path()); }),
            directory.path().string() + ": is a directory, a configuration file is expected");
}

TEST(SetParameter, OverridesAndRemembersIt) {
  Parameters p;
  ParameterPlaces places;
  set_parameter(p, "calibration.scale_left.prior_sigma=0.02", &places);
  set_parameter(p, "input.sensor_label=", &places);
  set_parameter(p, "input.odometry_label=a=b: \"c\"", &places);
  EXPECT_EQ(p.calibration.scale_left.prior_sigma, 0.02);
  EXPECT_EQ(p.input.sensor_label, "");
  EXPECT_EQ(p.input.odometry_label, "a=b: \"c\"");
  EXPECT_EQ(places.at("calibration.scale_left.prior_sigma"), "--set");
}

TEST(SetParameter, RejectsWithWhatWasWritten) {
  Parameters p;
  EXPECT_EQ(config_error_message([&] { set_parameter(p, "motion.model"); }),
            "--set 'motion.model': section.key=value is expected");
  EXPECT_EQ(config_error_message([&] { set_parameter(p, "motion.modl=ackermann"); }),
            "--set 'motion.modl=ackermann': unknown key 'motion.modl'; nearest valid key: "
            "motion.model");
  EXPECT_EQ(config_error_message([&] { set_parameter(p, "motion=ackermann"); }),
            "--set 'motion=ackermann': motion: is a section, set one of its keys");
  EXPECT_EQ(config_error_message([&] { set_parameter(p, "output.report=1"); }),
            "--set 'output.report=1': output.report: '1' is not true or false");
}

TEST(SetParameter, RejectsTextThatNoFileCouldHold) {
  Parameters p;
  config_error_message([&] { set_parameter(p, "input.sensor_label=\xFF\xFE"); });
  config_error_message([&] { set_parameter(p, "input.sensor_label=a\nb"); });
  EXPECT_EQ(p.input.sensor_label, "");
}

}  // namespace
}  // namespace libslam
