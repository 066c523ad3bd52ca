// Calibration while mapping, against the same filter that trusts its odometry. Bounds are those of
// the specification (S1, and the figures from six batches of fifty runs); the measured
// values stand beside them.

#include <tests/consistency/campaign_run.hpp>

#include <gtest/gtest.h>

using namespace libslam::test;

namespace {

void expect_mean_within(const CampaignRun& run, const char* variant, const char* parameter,
                        double truth, double tolerance, std::size_t point = 0) {
  const auto& found = run.cell(variant, point)["calibration"][parameter];
  EXPECT_NEAR(found["mean"]["mean"].get<double>(), truth, tolerance) << variant << " " << parameter;
}

}  // namespace

TEST(CalibrationGain, GrowsWithTheErrorAndCostsLittleWhereThereIsNone) {
  const CampaignRun run("mc_gain.yaml", {});
  // 0 %: what calibration costs.
  EXPECT_LE(run.ratio("calibrated", "standard", kPosition, 0), 1.05);           // 1.032
  EXPECT_LE(run.ratio("calibrated", "standard", kHeading, 0), 1.05);            // 1.043
  EXPECT_LE(run.ratio("invariant", "invariant_trusting", kPosition, 0), 1.05);  // 1.014
  EXPECT_LE(run.ratio("invariant", "invariant_trusting", kHeading, 0), 1.05);   // 1.029
  // 1, 2, 3, 5, 10 %: what it gains, more each time (.75 .50 .40 .26 .16).
  const double truths[] = {1.00, 1.01, 1.02, 1.03, 1.05, 1.10};
  for (std::size_t point = 1; point < 6; ++point) {
    EXPECT_LT(run.ratio("calibrated", "standard", kPosition, point),
              run.ratio("calibrated", "standard", kPosition, point - 1));
    for (const char* wheel : {"scale_left", "scale_right"}) {
      expect_mean_within(run, "calibrated", wheel, truths[point], 0.005, point);
      // Equal wheel speeds: the sum acts on the motion, the difference keeps its prior.
      EXPECT_EQ(run.cell("calibrated", point)["calibration"][wheel]["observable"]["mean"], 0.0);
    }
  }
  const std::size_t five_percent = 4;
  EXPECT_LE(run.ratio("calibrated", "standard", kPosition, five_percent), 0.40);  // .262
  EXPECT_LE(run.ratio("calibrated", "standard", kHeading, five_percent), 0.40);   // .223
  EXPECT_LE(run.ratio("invariant", "standard", kPosition, five_percent), 0.35);   // .227
  EXPECT_LE(run.ratio("invariant", "standard", kHeading, five_percent), 0.35);    // .196
  for (const char* variant : {"standard", "calibrated", "invariant", "invariant_trusting"})
    for (std::size_t point = 0; point < 6; ++point) EXPECT_EQ(run.done(variant, point), kRuns);
}

TEST(CalibrationGain, FindsEachWheelOfADifferentialDrive) {
  const CampaignRun run("mc_differential.yaml", {});
  EXPECT_LE(run.ratio("calibrated", "standard", kPosition), 0.10);  // .095
  EXPECT_LE(run.ratio("invariant", "standard", kPosition), 0.10);   // .068
  EXPECT_LE(run.ratio("invariant", "standard", kHeading), 0.10);    // .046
  for (const char* variant : {"calibrated", "invariant"}) {
    expect_mean_within(run, variant, "scale_left", 1.02, 0.006);
    expect_mean_within(run, variant, "scale_right", 0.99, 0.006);
    EXPECT_EQ(run.cell(variant)["calibration"]["scale_left"]["observable"]["mean"], 1.0);
  }
}

TEST(CalibrationGain, ASteeringBiasNeedsItsOwnParameter) {
  const CampaignRun run("mc_steering.yaml", {});
  EXPECT_GE(run.ratio("wheels", "standard", kPosition), 1.0);       // 1.07: wheel factors do harm
  EXPECT_LE(run.ratio("calibrated", "standard", kPosition), 0.12);  // .09
  EXPECT_LE(run.ratio("invariant", "standard", kPosition), 0.12);   // .07
  expect_mean_within(run, "invariant", "bias_steering", 3.14159265 / 180.0, 0.001);
  expect_mean_within(run, "invariant", "scale_speed", 1.05, 0.005);
}
