// Combinations of lines with the rest of a configuration.

#include <functional>

#include <gtest/gtest.h>

#include <libslam/config/validation.hpp>

namespace libslam {
namespace {

using Keys = std::vector<std::string>;

Parameters line_parameters() {
  Parameters p;
  p.measurement.model = "line";
  p.frontend.source = "scan_lines";
  p.association.method = "sequential_compatibility";
  return p;
}

/// All conflicts that a change makes.
std::vector<Keys> conflicts_of(const std::function<void(Parameters&)>& change) {
  Parameters p = line_parameters();
  change(p);
  std::vector<Keys> all;
  for (const Conflict& conflict : find_conflicts(p)) all.push_back(conflict.keys);
  return all;
}

struct Case {
  Keys keys;
  std::function<void(Parameters&)> change;
};

}  // namespace

TEST(LineValidation, SoundAsItIsAndWithAllThatLinesCanHave) {
  EXPECT_TRUE(conflicts_of([](Parameters&) {}).empty());
  EXPECT_TRUE(conflicts_of([](Parameters& p) {
                p.filter.building_prior.enabled = true;
                p.filter.loop_closure.enabled = true;
                p.filter.delayed_pose_distance = 1.0;
                p.association.merge_every = 10;
                p.calibration.bias_turn.enabled = p.calibration.scale_turn.enabled = true;
                p.policies.disturbance.response = "maximum_likelihood";
                p.policies.disturbance.relocalize = false;
              }).empty());
}

TEST(LineValidation, RefusesWhatDoesNotGoWithLines) {
  const Case cases[] = {
      {{"measurement.model", "frontend.source"},
       [](Parameters& p) { p.frontend.source = "range_bearing"; }},
      {{"measurement.model", "frontend.source"},
       [](Parameters& p) { p.measurement.model = "range_bearing"; }},
      {{"association.method", "measurement.model"},
       [](Parameters& p) { p.association.method = "known"; }},
      {{"association.method", "measurement.model"},
       [](Parameters& p) { p.association.method = "known_or_joint"; }},
      {{"filter.linearization", "measurement.model"},
       [](Parameters& p) {
         p.filter.error_frame = "standard";
         p.filter.linearization = "first_estimate";
       }},
      {{"policies.noise_adaptation.method", "measurement.model"},
       [](Parameters& p) { p.policies.noise_adaptation.method = "residual"; }},
      {{"policies.disturbance.relocalize", "measurement.model"},
       [](Parameters& p) {
         p.policies.disturbance.response = "maximum_likelihood";
         p.policies.disturbance.relocalize = true;
       }},
      {{"filter.loop_closure.enabled", "filter.delayed_pose_distance"},
       [](Parameters& p) { p.filter.loop_closure.enabled = true; }},
      {{"calibration.bias_turn.enabled", "motion.model"},
       [](Parameters& p) {
         p.motion.model = "differential";
         p.calibration.bias_turn.enabled = true;
       }},
  };
  for (const Case& one : cases) {
    const auto found = conflicts_of(one.change);
    EXPECT_NE(std::find(found.begin(), found.end(), one.keys), found.end()) << one.keys.front();
  }
  const auto in_space = conflicts_of([](Parameters& p) {
    p.motion.model = "body_twist";
    p.input.odometry = "twist";
  });
  EXPECT_NE(
      std::find(in_space.begin(), in_space.end(), (Keys{"measurement.model", "motion.model"})),
      in_space.end());
}

TEST(LineValidation, PointsHaveNoneOfTheirUpkeep) {
  const std::pair<const char*, std::function<void(Parameters&)>> cases[] = {
      {"filter.building_prior.enabled",
       [](Parameters& p) { p.filter.building_prior.enabled = true; }},
      {"association.merge_every", [](Parameters& p) { p.association.merge_every = 5; }}};
  for (const auto& [key, change] : cases) {
    Parameters p;
    change(p);
    const auto conflicts = find_conflicts(p);
    ASSERT_EQ(conflicts.size(), 1u) << key;
    EXPECT_EQ(conflicts[0].keys, (Keys{key, "measurement.model"}));
  }
}

}  // namespace libslam
