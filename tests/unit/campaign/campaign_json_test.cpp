#include <limits>

#include <gtest/gtest.h>

#include "campaign_fixture.hpp"

namespace libslam {
namespace {

using namespace test;
using Outcomes = std::vector<std::optional<RunOutcome>>;

/// Two runs of two variants, both done, with chosen errors.
Outcomes two_runs() {
  Outcomes outcomes;
  for (int run = 0; run < 2; ++run) {
    RunOutcome outcome = outcome_of(2, "done");
    for (std::size_t v = 0; v < 2; ++v) {
      const double scale = v == 0 ? 4.0 : 1.0;
      outcome.variants[v].sums = {scale * (run + 1), scale, 0.0, 2};
      outcome.variants[v].nees = {std::numeric_limits<double>::quiet_NaN(), 2.0, 4.0};
      outcome.variants[v].figures = {{"truth", {{"nees_mean", 3.0}}},
                                     {"timing", {{"filter_s", 1}}}};
    }
    outcomes.push_back(outcome);
  }
  return outcomes;
}

TEST(CampaignJson, PoolsErrorsAndComparesPairs) {
  const auto out = campaign_to_json(small_plan(2), two_runs(), {"sha", 1.5, 4});
  ASSERT_EQ(out["cells"].size(), 2U);
  const auto& cell = out["cells"][1];
  EXPECT_DOUBLE_EQ(cell["pooled"]["rmse_x_m"], std::sqrt(3.0 / 4.0));
  EXPECT_DOUBLE_EQ(cell["pooled"]["rmse_position_m"], std::sqrt(5.0 / 4.0));
  EXPECT_EQ(cell["comparison"]["reference"], "standard");
  EXPECT_DOUBLE_EQ(cell["comparison"]["rmse_position"]["ratio"], 0.5);
  EXPECT_EQ(cell["comparison"]["rmse_position"]["pairs"], 2);
  EXPECT_FALSE(out["cells"][0].contains("comparison"));
  EXPECT_EQ(out["config_sha256"], "sha");
  EXPECT_EQ(out["timing"]["workers"], 4);
}

TEST(CampaignJson, TimesAndMeansOfNeesHaveOneLength) {
  const auto out = campaign_to_json(small_plan(2), two_runs(), {});
  const auto& nees = out["cells"][0]["nees"];
  EXPECT_EQ(nees["steps"], 3);
  EXPECT_EQ(nees["times_s"].size(), 3U);
  EXPECT_DOUBLE_EQ(nees["times_s"][2], 0.4);
  EXPECT_EQ(nees["mean"][2], 4.0);
  EXPECT_EQ(nees["time_mean"], 3.0);
}

TEST(CampaignJson, FirstRunThatFailedTakesNothingFromTheOthers) {
  Outcomes outcomes = two_runs();
  outcomes[0] = outcome_of(2, "failed: why");
  const auto out = campaign_to_json(small_plan(2), outcomes, {});
  const auto& cell = out["cells"][1];
  EXPECT_EQ(cell["counts"]["failed"], 1);
  EXPECT_EQ(cell["counts"]["done"], 1);
  EXPECT_EQ(cell["nees"]["times_s"].size(), 3U);
  EXPECT_EQ(cell["comparison"]["rmse_position"]["pairs"], 1);
  EXPECT_EQ(cell["runs"][0]["status"], "failed: why");
}

TEST(CampaignJson, FigureThatOnlyALaterRunHasIsReported) {
  Outcomes outcomes = two_runs();
  outcomes[1]->variants[0].figures["truth"]["map_rmse_m"] = 0.25;
  const auto out = campaign_to_json(small_plan(2), outcomes, {});
  EXPECT_EQ(out["cells"][0]["truth"]["map_rmse_m"]["mean"], 0.25);
  EXPECT_EQ(out["cells"][0]["truth"]["nees_mean"]["mean"], 3.0);
}

TEST(CampaignJson, UnfinishedCampaignSaysWhatWasNotRun) {
  Outcomes outcomes = two_runs();
  outcomes[1].reset();
  const auto out = campaign_to_json(small_plan(2), outcomes, {});
  EXPECT_EQ(out["cells"][0]["counts"]["not_run"], 1);
  EXPECT_EQ(out["cells"][0]["runs"][1]["status"], "not run");
  EXPECT_FALSE(campaign_to_json(small_plan(2), Outcomes(2), {})["cells"][0].contains("nees"));
}

}  // namespace
}  // namespace libslam
