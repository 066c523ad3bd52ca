// Which combinations of motion, odometry, front-end and landmarks are sound in space.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <libslam/config/validation.hpp>

namespace libslam {
namespace {

Parameters in_space() {
  Parameters p;
  p.input.odometry = "twist";
  p.motion.model = "body_twist";
  p.frontend.source = "stereo_points";
  p.measurement.model = "stereo_point";
  return p;
}

/// The first key of every conflict.
std::vector<std::string> culprits(const Parameters& p) {
  std::vector<std::string> keys;
  for (const Conflict& conflict : find_conflicts(p)) keys.push_back(conflict.keys.front());
  return keys;
}

bool blames(const Parameters& p, const std::string& key) {
  const auto keys = culprits(p);
  return std::ranges::find(keys, key) != keys.end();
}

TEST(SpatialValidation, AcceptsWhatIsSound) {
  EXPECT_EQ(culprits(in_space()), std::vector<std::string>{});
  Parameters p = in_space();
  p.calibration.bias_gyro_y.enabled = p.calibration.scale_speed.enabled = true;
  p.policies.implied_input.enabled = true;
  p.association.forget_after = 2;
  EXPECT_EQ(culprits(p), std::vector<std::string>{});
  p = in_space();
  p.motion.model = "constant_twist";
  p.input.odometry = "none";
  EXPECT_EQ(culprits(p), std::vector<std::string>{});
  p = Parameters();
  p.frontend.source = "stereo_points";
  p.measurement.model = "stereo_point";
  for (const int dimension : {2, 3}) {
    p.measurement.stereo.landmark_dimension = dimension;
    EXPECT_EQ(culprits(p), std::vector<std::string>{}) << dimension;
  }
}

TEST(SpatialValidation, IterationsLookForTheirPointOfLinearizationThemselves) {
  Parameters p = in_space();
  p.filter.update_linearizations = 3;
  EXPECT_EQ(culprits(p), std::vector<std::string>{});
  p = Parameters();
  p.filter.update_linearizations = 3;
  EXPECT_EQ(culprits(p), std::vector<std::string>{});
  p.filter.error_frame = "standard";
  p.filter.linearization = "first_estimate";
  EXPECT_EQ(culprits(p), std::vector<std::string>{"filter.update_linearizations"});
  p.filter.linearization = "estimate";
  p.measurement.model = p.frontend.source = "sensor_displacement";
  EXPECT_TRUE(blames(p, "filter.update_linearizations"));
}

TEST(SpatialValidation, TwistAndBodyTwistBelongTogether) {
  Parameters p = in_space();
  p.input.odometry = "auto";
  EXPECT_TRUE(blames(p, "input.odometry"));
  p = in_space();
  p.motion.model = "differential";
  EXPECT_TRUE(blames(p, "input.odometry"));
  p = in_space();
  p.motion.model = "constant_twist";
  EXPECT_TRUE(blames(p, "input.odometry"));
}

TEST(SpatialValidation, ARobotInSpaceNeedsPointsInSpace) {
  Parameters p = in_space();
  p.measurement.stereo.landmark_dimension = 2;
  EXPECT_TRUE(blames(p, "motion.model"));
  p = in_space();
  p.measurement.model = "range_bearing";
  p.frontend.source = "range_bearing";
  EXPECT_TRUE(blames(p, "motion.model"));
}

TEST(SpatialValidation, PointsComeFromTheirFrontEnd) {
  Parameters p = in_space();
  p.frontend.source = "range_bearing";
  EXPECT_TRUE(blames(p, "measurement.model"));
  p = Parameters();
  p.frontend.source = "stereo_points";
  EXPECT_TRUE(blames(p, "measurement.model"));
}

TEST(SpatialValidation, RefusesParametersWithoutEffect) {
  Parameters p = in_space();
  p.calibration.scale_left.enabled = true;
  EXPECT_TRUE(blames(p, "calibration.scale_left.enabled"));
  p = Parameters();
  p.motion.model = "differential";
  p.calibration.bias_gyro_z.enabled = true;
  EXPECT_TRUE(blames(p, "calibration.bias_gyro_z.enabled"));
  p = in_space();
  p.filter.linearization = "first_estimate";
  p.filter.error_frame = "standard";
  EXPECT_TRUE(blames(p, "filter.linearization"));
  p = in_space();
  p.policies.implied_input = {true, 1.0};
  EXPECT_TRUE(blames(p, "policies.implied_input.probability"));
}

// One bad observation makes every landmark start anew: never those of a map that is to last.
TEST(SpatialValidation, ImpossibleMotionsNeedLandmarksThatAreForgotten) {
  Parameters p = in_space();
  p.policies.implied_input.enabled = true;
  EXPECT_TRUE(blames(p, "policies.implied_input.enabled"));
  p.association.forget_after = 2;
  EXPECT_FALSE(blames(p, "policies.implied_input.enabled"));
  p.association.forget_after = 0;
  p.map.file = "map.yaml";
  EXPECT_FALSE(blames(p, "policies.implied_input.enabled"));
  p.map.mode = "continue";
  EXPECT_TRUE(blames(p, "policies.implied_input.enabled"));
}

}  // namespace
}  // namespace libslam
