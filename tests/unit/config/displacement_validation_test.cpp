// Combinations of displacement measurements with the rest of a configuration.

#include <functional>

#include <gtest/gtest.h>

#include <libslam/config/validation.hpp>

namespace libslam {
namespace {

Parameters displacement_parameters() {
  Parameters p;
  p.input.sensor_label = "scan_matching";
  p.motion.model = "differential";
  p.calibration.scale_left.enabled = p.calibration.sensor_phi.enabled = true;
  p.frontend.source = "sensor_path";
  p.measurement.model = "sensor_displacement";
  return p;
}

using Keys = std::vector<std::string>;

Keys first_conflict(const std::function<void(Parameters&)>& change) {
  Parameters p = displacement_parameters();
  change(p);
  const auto conflicts = find_conflicts(p);
  return conflicts.empty() ? Keys{} : conflicts.front().keys;
}

TEST(DisplacementValidation, SoundAsItIs) {
  EXPECT_EQ(first_conflict([](Parameters&) {}), Keys{});
  EXPECT_EQ(first_conflict([](Parameters& p) { p.calibration.sensor_x.enabled = true; }), Keys{});
}

TEST(DisplacementValidation, ModelAndSourceBelongTogether) {
  const Keys both{"measurement.model", "frontend.source"};
  EXPECT_EQ(first_conflict([](Parameters& p) { p.frontend.source = "range_bearing"; }), both);
  EXPECT_EQ(first_conflict([](Parameters& p) { p.measurement.model = "range_bearing"; }), both);
}

TEST(DisplacementValidation, LandmarkModelsDoNotEstimateTheSensor) {
  const auto of_landmarks = [](Parameters& p) {
    p = {};
    p.calibration.sensor_y.enabled = true;
  };
  EXPECT_EQ(first_conflict(of_landmarks),
            (Keys{"calibration.sensor_y.enabled", "measurement.model"}));
}

TEST(DisplacementValidation, ThePathHasALabelOfItsOwn) {
  EXPECT_EQ(first_conflict([](Parameters& p) { p.input.sensor_label = ""; }),
            (Keys{"input.sensor_label", "measurement.model"}));
  EXPECT_EQ(first_conflict([](Parameters& p) { p.input.odometry_label = "scan_matching"; }),
            (Keys{"input.sensor_label", "input.odometry_label"}));
}

TEST(DisplacementValidation, NeedsOdometryAndLinearizationAtTheEstimate) {
  const auto without_odometry = [](Parameters& p) {
    p.calibration.scale_left.enabled = false;
    p.input.odometry = "none";
    p.motion.no_odometry_sigma_xy = p.motion.no_odometry_sigma_heading_deg = 1.0;
  };
  EXPECT_EQ(first_conflict(without_odometry), (Keys{"measurement.model", "input.odometry"}));
  const auto first_estimate = [](Parameters& p) {
    p.filter.error_frame = "standard";
    p.filter.linearization = "first_estimate";
  };
  EXPECT_EQ(first_conflict(first_estimate), (Keys{"filter.linearization", "measurement.model"}));
}

}  // namespace
}  // namespace libslam
