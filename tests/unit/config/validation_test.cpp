#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <libslam/config/validation.hpp>

#include "support/config_error_message.hpp"

namespace libslam {
namespace {

TEST(Validation, DefaultsAreSound) {
  EXPECT_TRUE(find_conflicts({}).empty());
}

struct Case {
  const char* name;
  std::function<void(Parameters&)> make;
  std::vector<std::string> keys;  ///< of the only conflict; empty: legal
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

class ValidationOf : public testing::TestWithParam<Case> {};

TEST_P(ValidationOf, NamesTheKeysAndSaysWhy) {
  Parameters p;
  GetParam().make(p);
  const std::vector<Conflict> conflicts = find_conflicts(p);
  if (GetParam().keys.empty()) {
    EXPECT_TRUE(conflicts.empty()) << conflicts.front().keys.front() << conflicts.front().reason;
    EXPECT_NO_THROW(validate(p));
    return;
  }
  ASSERT_FALSE(conflicts.empty());
  EXPECT_EQ(conflicts.front().keys, GetParam().keys);
  EXPECT_GT(conflicts.front().reason.size(), 20U);
  const std::string message = test::config_error_message([&] { validate(p); });
  for (const std::string& key : GetParam().keys) {
    EXPECT_NE(message.find(key + " = "), std::string::npos) << message;
  }
  EXPECT_NE(message.find(conflicts.front().reason), std::string::npos) << message;
}

const Case kCalibration[] = {
    {"left_right_track_of_differential",
     [](Parameters& p) {
       p.motion.model = "differential";
       p.calibration.scale_left.enabled = p.calibration.scale_right.enabled = true;
       p.calibration.track_width.enabled = true;
     },
     {}},
    {"left_right_steering_of_ackermann",
     [](Parameters& p) {
       p.motion.model = "ackermann";
       p.calibration.scale_left.enabled = p.calibration.scale_right.enabled = true;
       p.calibration.scale_steering.enabled = p.calibration.bias_steering.enabled = true;
     },
     {}},
    {"speed_of_ackermann",
     [](Parameters& p) {
       p.motion.model = "ackermann";
       p.calibration.scale_speed.enabled = true;
     },
     {}},
    {"left_of_increments",
     [](Parameters& p) { p.calibration.scale_left.enabled = true; },
     {"calibration.scale_left.enabled", "motion.model"}},
    {"track_width_of_increments",
     [](Parameters& p) { p.calibration.track_width.enabled = true; },
     {"calibration.track_width.enabled", "motion.model"}},
    {"track_width_of_ackermann",
     [](Parameters& p) {
       p.motion.model = "ackermann";
       p.calibration.track_width.enabled = true;
     },
     {"calibration.track_width.enabled", "motion.model"}},
    {"speed_of_differential",
     [](Parameters& p) {
       p.motion.model = "differential";
       p.calibration.scale_speed.enabled = true;
     },
     {"calibration.scale_speed.enabled", "motion.model"}},
    {"steering_of_differential",
     [](Parameters& p) {
       p.motion.model = "differential";
       p.calibration.scale_steering.enabled = true;
     },
     {"calibration.scale_steering.enabled", "motion.model"}},
    {"steering_bias_of_differential",
     [](Parameters& p) {
       p.motion.model = "differential";
       p.calibration.bias_steering.enabled = true;
     },
     {"calibration.bias_steering.enabled", "motion.model"}},
    {"speed_beside_left",
     [](Parameters& p) {
       p.motion.model = "ackermann";
       p.calibration.scale_speed.enabled = p.calibration.scale_left.enabled = true;
     },
     {"calibration.scale_speed.enabled", "calibration.scale_left.enabled"}},
    {"speed_beside_right",
     [](Parameters& p) {
       p.motion.model = "ackermann";
       p.calibration.scale_speed.enabled = p.calibration.scale_right.enabled = true;
     },
     {"calibration.scale_speed.enabled", "calibration.scale_right.enabled"}},
    {"inert_prior",
     [](Parameters& p) {
       p.motion.model = "differential";
       p.calibration.scale_left.enabled = true;
       p.calibration.scale_left.prior_sigma = 0.0;
     },
     {"calibration.scale_left.prior_sigma"}},
    {"factor_of_zero",
     [](Parameters& p) { p.calibration.scale_right.prior_mean = 0.0; },
     {"calibration.scale_right.prior_mean"}},
    {"steering_bias_of_a_quarter_turn",
     [](Parameters& p) { p.calibration.bias_steering.prior_mean = -1.6; },
     {"calibration.bias_steering.prior_mean"}},
    {"negative_steering_bias",
     [](Parameters& p) { p.calibration.bias_steering.prior_mean = -0.05; },
     {}},
};

const Case kOthers[] = {
    {"ticks_of_differential",
     [](Parameters& p) {
       p.motion.model = "differential";
       p.input.odometry = "ticks";
     },
     {}},
    {"ticks_of_increments",
     [](Parameters& p) { p.input.odometry = "ticks"; },
     {"input.odometry", "motion.model"}},
    {"ticks_of_ackermann",
     [](Parameters& p) {
       p.motion.model = "ackermann";
       p.motion.encoder_offset = 0.76;
       p.input.odometry = "ticks";
     },
     {"input.odometry", "motion.model"}},
    {"ticks_without_length",
     [](Parameters& p) {
       p.motion.model = "differential";
       p.input.odometry = "ticks";
       p.motion.metres_per_tick_right = 0.0;
     },
     {"motion.metres_per_tick_right", "input.odometry"}},
    {"no_odometry_and_no_noise",
     [](Parameters& p) { p.input.odometry = "none"; },
     {"input.odometry", "motion.no_odometry_sigma_xy", "motion.no_odometry_sigma_heading_deg"}},
    {"no_odometry",
     [](Parameters& p) {
       p.input.odometry = "none";
       p.motion.no_odometry_sigma_xy = p.motion.no_odometry_sigma_heading_deg = 0.1;
     },
     {}},
    {"calibration_without_odometry",
     [](Parameters& p) {
       p.input.odometry = "none";
       p.motion.no_odometry_sigma_xy = p.motion.no_odometry_sigma_heading_deg = 0.1;
       p.motion.model = "differential";
       p.calibration.track_width.enabled = true;
     },
     {"calibration.track_width.enabled", "input.odometry"}},
    {"empty_range",
     [](Parameters& p) { p.frontend.min_range = p.frontend.max_range = 5.0; },
     {"frontend.min_range", "frontend.max_range"}},
    {"gate_of_zero",
     [](Parameters& p) { p.association.gate_probability = 0.0; },
     {"association.gate_probability"}},
    {"known_without_gate",
     [](Parameters& p) {
       p.association.method = "known";
       p.association.gate_probability = 1.0;
     },
     {}},
    {"nearest_without_gate",
     [](Parameters& p) {
       p.association.method = "nearest_neighbour";
       p.association.gate_probability = p.association.new_landmark_probability = 1.0;
     },
     {"association.gate_probability", "association.method"}},
    {"overlapping_gates",
     [](Parameters& p) {
       p.association.method = "nearest_neighbour";
       p.association.gate_probability = 0.999;
       p.association.new_landmark_probability = 0.99;
     },
     {"association.gate_probability", "association.new_landmark_probability"}},
    {"overlapping_gates_without_effect",
     [](Parameters& p) {
       p.association.method = "known";
       p.association.gate_probability = 0.9999;
     },
     {}},
    {"equal_gates",
     [](Parameters& p) {
       p.association.method = "known_or_nearest";
       p.association.gate_probability = p.association.new_landmark_probability = 0.99;
     },
     {}},
    {"no_new_landmarks",
     [](Parameters& p) {
       p.association.method = "nearest_neighbour";
       p.association.new_landmark_probability = 1.0;
     },
     {"association.new_landmark_probability"}},
    {"pruned_before_confirmed",
     [](Parameters& p) {
       p.association.confirm_after = 5;
       p.association.prune_after = 3;
     },
     {"association.prune_after", "association.confirm_after"}},
    {"confirmed_just_in_time",
     [](Parameters& p) {
       p.association.confirm_after = 5;
       p.association.prune_after = 4;
     },
     {}},
    {"nothing_to_stretch",
     [](Parameters& p) { p.policies.update_schedule.per_feature = 0.08; },
     {"policies.update_schedule.per_feature", "policies.update_period_s"}},
    {"composed_schedules",
     [](Parameters& p) {
       p.policies.update_period_s = 0.5;
       p.policies.update_every_n = 2;
       p.policies.update_schedule.per_feature = 0.08;
       p.policies.update_schedule.distance = 0.2;
     },
     {}},
    {"absolute_stretch",
     [](Parameters& p) {
       p.policies.update_schedule.per_feature = 0.08;
       p.policies.update_schedule.form = "absolute";
     },
     {}},
    {"out_of_range",
     [](Parameters& p) { p.measurement.sigma_range = -1.0; },
     {"measurement.sigma_range"}},
    {"not_a_number",
     [](Parameters& p) { p.motion.wheelbase = std::numeric_limits<double>::quiet_NaN(); },
     {"motion.wheelbase"}},
    {"unknown_choice",
     [](Parameters& p) { p.filter.error_frame = "invariant"; },
     {"filter.error_frame"}},
};

std::string name_of(const testing::TestParamInfo<Case>& info) {
  return info.param.name;
}

const Case kFilter[] = {
    {"loops_of_scans",
     [](Parameters& p) {
       p.frontend.source = "scan_lines";
       p.measurement.model = "line";
       p.association.method = "sequential_compatibility";
       p.filter.delayed_pose_distance = 2.0;
       p.filter.loop_closure.enabled = true;
     },
     {}},
    {"loops_without_a_past",
     [](Parameters& p) {
       p.frontend.source = "scan_lines";
       p.measurement.model = "line";
       p.association.method = "sequential_compatibility";
       p.filter.loop_closure.enabled = true;
     },
     {"filter.loop_closure.enabled", "filter.delayed_pose_distance"}},
    {"loops_without_scans",
     [](Parameters& p) {
       p.filter.delayed_pose_distance = 2.0;
       p.filter.loop_closure.enabled = true;
     },
     {"filter.loop_closure.enabled", "frontend.source"}},
    {"first_estimate_in_the_standard_frame",
     [](Parameters& p) {
       p.filter.error_frame = "standard";
       p.filter.linearization = "first_estimate";
     },
     {}},
    {"first_estimate_in_the_invariant_frame",
     [](Parameters& p) { p.filter.linearization = "first_estimate"; },
     {"filter.linearization", "filter.error_frame"}},
    {"at_truth_of_a_log",
     [](Parameters& p) {
       p.filter.error_frame = "standard";
       p.filter.linearization = "at_truth";
     },
     {"filter.linearization"}},
};

const Case kAdaptation[] = {
    {"adapts_measurement_noise",
     [](Parameters& p) { p.policies.noise_adaptation.method = "residual"; },
     {}},
    {"adapts_process_noise",
     [](Parameters& p) { p.policies.process_adaptation.method = "scale"; },
     {}},
    {"both_from_the_same_innovations",
     [](Parameters& p) {
       p.policies.noise_adaptation.method = "residual";
       p.policies.process_adaptation.method = "scale";
     },
     {"policies.process_adaptation.method", "policies.noise_adaptation.method"}},
    {"bias_in_slam",
     [](Parameters& p) {
       p.policies.noise_adaptation.method = "residual";
       p.policies.noise_adaptation.bias = true;
     },
     {"policies.noise_adaptation.bias", "map.mode"}},
    {"bias_in_a_known_map",
     [](Parameters& p) {
       p.map.file = "surveyed.csv";
       p.policies.noise_adaptation.method = "residual";
       p.policies.noise_adaptation.bias = true;
     },
     {}},
    {"planar_stereo",
     [](Parameters& p) {
       p.frontend.source = "stereo_points";
       p.measurement.model = "stereo_point";
       p.measurement.stereo.landmark_dimension = 2;
       p.policies.noise_adaptation.method = "residual";
     },
     {"policies.noise_adaptation.method", "measurement.stereo.landmark_dimension"}},
    {"bias_without_adaptation",
     [](Parameters& p) { p.policies.noise_adaptation.bias = true; },
     {"policies.noise_adaptation.bias", "policies.noise_adaptation.method"}},
    {"floor_above_ceiling",
     [](Parameters& p) {
       p.policies.noise_adaptation.method = "classic";
       p.policies.noise_adaptation.min_sigma_range = 200.0;
     },
     {"policies.noise_adaptation.min_sigma_range", "policies.noise_adaptation.max_sigma_range"}},
    {"bearing_floor_above_ceiling",
     [](Parameters& p) {
       p.policies.noise_adaptation.method = "residual";
       p.policies.noise_adaptation.max_sigma_bearing_deg = 0.001;
     },
     {"policies.noise_adaptation.min_sigma_bearing_deg",
      "policies.noise_adaptation.max_sigma_bearing_deg"}},
    {"factor_floor_above_ceiling",
     [](Parameters& p) {
       p.policies.process_adaptation.method = "scale";
       p.policies.process_adaptation.min_factor = 1000.0;
     },
     {"policies.process_adaptation.min_factor", "policies.process_adaptation.max_factor"}},
};

INSTANTIATE_TEST_SUITE_P(Calibration, ValidationOf, testing::ValuesIn(kCalibration), name_of);
INSTANTIATE_TEST_SUITE_P(Others, ValidationOf, testing::ValuesIn(kOthers), name_of);
INSTANTIATE_TEST_SUITE_P(Adaptation, ValidationOf, testing::ValuesIn(kAdaptation), name_of);
INSTANTIATE_TEST_SUITE_P(Filter, ValidationOf, testing::ValuesIn(kFilter), name_of);

TEST(Validation, OnlySimulationsKnowTheTruthAndOnlyByIdentity) {
  Parameters p;
  p.filter.error_frame = "standard";
  p.filter.linearization = "at_truth";
  EXPECT_TRUE(find_conflicts(p, TruthAccess::kSimulation).empty());
  p.association.method = "nearest_neighbour";
  EXPECT_EQ(find_conflicts(p, TruthAccess::kSimulation).front().keys,
            (std::vector<std::string>{"filter.linearization", "association.method"}));
}

TEST(Validation, PointsToTheLineThatSetTheParameter) {
  ParameterPlaces places;
  const Parameters p =
      load_yaml_text("frontend:\n  max_range: 3\n  min_range: 4\n", "c.yaml", &places);
  EXPECT_EQ(test::config_error_message([&] { validate(p, places); }),
            "c.yaml:3:3: frontend.min_range = 4 with frontend.max_range = 3: no observation lies "
            "between a nearest and a farthest range in this order");
}

TEST(Validation, PointsToTheSecondKeyWhereTheFirstIsADefault) {
  ParameterPlaces places;
  Parameters p;
  set_parameter(p, "input.odometry=ticks", &places);
  EXPECT_EQ(test::config_error_message([&] { validate(p, places); }).substr(0, 22),
            "--set: input.odometry ");
  ParameterPlaces only_model{{"motion.model", "c.yaml:2:3"}};
  EXPECT_EQ(test::config_error_message([&] { validate(p, only_model); }).substr(0, 12),
            "c.yaml:2:3: ");
}

}  // namespace
}  // namespace libslam
