#include <stdexcept>

#include <gtest/gtest.h>

#include <libslam/motion/calibration_layout.hpp>

namespace libslam {
namespace {

TEST(CalibrationLayout, KeepsEnabledParametersInOrder) {
  CalibrationParameters parameters;
  parameters.bias_steering = {true, 0.01, 0.02, 0.003};
  parameters.scale_right = {true, 0.98, 0.05, 0.0};
  parameters.scale_left.prior_mean = 1.02;
  const CalibrationLayout layout(parameters, {kScaleLeft, kScaleRight, kBiasSteering}, "test");
  ASSERT_EQ(layout.specs().size(), 2u);
  EXPECT_EQ(layout.specs()[0].name, "scale_right");
  EXPECT_EQ(layout.specs()[1].name, "bias_steering");
  EXPECT_EQ(layout.specs()[1].prior_mean, 0.01);
  EXPECT_EQ(layout.specs()[1].prior_sigma, 0.02);
  EXPECT_EQ(layout.specs()[1].random_walk, 0.003);
  EXPECT_EQ(layout.indices(), (std::vector{kScaleRight, kBiasSteering}));
  EXPECT_EQ(layout.priors()[kScaleLeft], 1.02);
  EXPECT_EQ(layout.priors()[kTrackWidth], 1.0);
  EXPECT_TRUE(layout.enabled(kScaleRight));
  EXPECT_FALSE(layout.enabled(kScaleLeft));
}

TEST(CalibrationLayout, RefusesWhatTheModelCannotObserve) {
  CalibrationParameters parameters;
  parameters.track_width.enabled = true;
  try {
    CalibrationLayout(parameters, {kScaleSpeed}, "ackermann");
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("track_width"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("ackermann"), std::string::npos);
  }
}

}  // namespace
}  // namespace libslam
