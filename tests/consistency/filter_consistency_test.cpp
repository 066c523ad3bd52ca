// Does the covariance tell the truth? The same check for every filter: the invariant one passes,
// the standard one fails, and the ideal one (derivatives at the truth) says what is possible.

#include <string>
#include <tests/consistency/campaign_run.hpp>

#include <gtest/gtest.h>

using namespace libslam::test;

namespace {

/// Bounds of the specification: mean over batches of the steps inside the 95 % band of fifty runs
/// (NEES is correlated in time, so that even the ideal filter is inside for .79-.99 of the steps,
/// batch by batch), runs inside the 95 % ellipsoid, NEES averaged over time (ideal 3).
bool is_consistent(const CampaignRun& run, const std::string& variant) {
  const auto& cell = run.cell(variant);
  const double in_band = cell["nees"]["fraction_in_band"];
  const double ideal = run.cell("ideal")["nees"]["fraction_in_band"];
  const double coverage = cell["truth"]["nees_coverage_95"]["mean"];
  const double mean = cell["nees"]["time_mean"];
  return in_band >= 0.80 && in_band >= ideal - 0.08 && coverage >= 0.92 && mean >= 2.6 &&
         mean <= 3.6;
}

class FilterConsistencyOver : public testing::TestWithParam<const char*> {};

}  // namespace

TEST_P(FilterConsistencyOver, TheInvariantFrameIsAlmostIdealAndTheStandardOneIsNot) {
  const std::string laps = GetParam();
  const CampaignRun run("mc_webmap.yaml", {"scenario.drive.laps=" + laps});
  SCOPED_TRACE(laps + " laps: " + run.cell("invariant")["nees"]["batches"].dump());
  for (const char* variant : {"standard", "calibrated", "invariant", "ideal"})
    EXPECT_EQ(run.done(variant), kRuns) << variant;
  EXPECT_TRUE(is_consistent(run, "ideal"));
  EXPECT_TRUE(is_consistent(run, "invariant"));
  EXPECT_FALSE(is_consistent(run, "calibrated"));
  EXPECT_FALSE(is_consistent(run, "standard"));
  EXPECT_LE(run.ratio("invariant", "ideal", kPosition), 1.03);
  EXPECT_LE(run.ratio("invariant", "ideal", kHeading), 1.03);
  EXPECT_LE(run.ratio("invariant", "calibrated", kPosition), 0.93);
}

INSTANTIATE_TEST_SUITE_P(Laps, FilterConsistencyOver, testing::Values("1", "3"));

// Three laps with up to five times the steering noise. First-estimates Jacobians keep what a bad
// first estimate did to them; the invariant filter has nothing to keep.
TEST(FilterConsistency, NoRunDivergesWhereFirstEstimatesDo) {
  const CampaignRun run("mc_large_drift.yaml", {"campaign.batches=1"});
  int first_estimates = 0;
  for (const std::size_t point : {0U, 1U, 2U}) {
    EXPECT_EQ(run.done("invariant", point), 50);
    EXPECT_EQ(run.done("ideal", point), 50);
    EXPECT_LT(run.ratio("invariant", "standard", kPosition, point), 0.93);
    first_estimates += run.done("first_estimates", point);
  }
  EXPECT_LE(first_estimates, 140);  // 134
}

// Without identities and with drift beyond half the distance between landmarks.
TEST(FilterConsistency, FindsItsWayWithoutIdentities) {
  const CampaignRun run("mc_unknown_association.yaml", {"campaign.batches=1"});
  EXPECT_EQ(run.done("invariant", 0), 50);
  EXPECT_GE(run.done("invariant", 2), 45);                           // 48
  EXPECT_GT(run.done("invariant", 2), run.done("standard", 2) + 8);  // 34
}
