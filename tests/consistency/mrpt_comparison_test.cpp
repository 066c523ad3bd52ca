// MRPT's own class on the same logs: where its numerics hold, it is our standard filter.

#include <tests/consistency/campaign_run.hpp>

#include <gtest/gtest.h>

using namespace libslam::test;

TEST(MrptComparison, StandardFilterIsTheSameAndTheInvariantOneIsBetter) {
  const CampaignRun run("mc_mrpt.yaml", {"campaign.batches=1"});
  for (const std::size_t point : {0U, 1U}) {
    for (const char* variant : {"standard", "invariant_trusting", "invariant"})
      EXPECT_EQ(run.done(variant, point), 50);
    EXPECT_GT(run.done("mrpt", point), 25);  // 38 and 35: the others diverge numerically
    EXPECT_EQ(run.done("mrpt_davison", point), 50);
    const auto& same = run.cell("mrpt", point)["comparison"]["rmse_position"];
    EXPECT_NEAR(same["ratio"].get<double>(), 1.0, 0.01);  // over the pairs
    const auto& better = run.cell("invariant", point)["comparison"]["rmse_position"];
    EXPECT_LT(better["upper"].get<double>(), 1.0);
  }
}
