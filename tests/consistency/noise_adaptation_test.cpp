// Measurement noise that is not what the filter was told, in SLAM and in a known map; fifty paired
// runs. Bounds are those of the issue, beside them what was measured.

#include <cmath>
#include <cstdio>
#include <string>
#include <tests/consistency/campaign_run.hpp>
#include <tests/consistency/known_map_run.hpp>

#include <gtest/gtest.h>

#include <libslam/pipeline/simulation.hpp>

using namespace libslam;
using namespace libslam::test;

namespace {

constexpr int kPaired = 50;

double nees(const CampaignRun& run, const std::string& variant, std::size_t point = 0) {
  return run.cell(variant, point)["nees"]["time_mean"];
}

Scenario webmap() {
  Scenario scenario = load_scenario(std::filesystem::path(LIBSLAM_CONFIG_DIR) / "sim_webmap.yaml");
  scenario.truth = {};
  return scenario;
}

Parameters told(const Scenario& scenario, const char* method) {
  Parameters parameters = nominal_filter(scenario);
  parameters.measurement.noise = "configured";
  parameters.filter.error_frame = "standard";  // a known map leaves no direction unobservable
  parameters.policies.noise_adaptation.method = method;
  return parameters;
}

}  // namespace

TEST(NoiseAdaptation, CostsNothingWhereTheNoiseIsRightAndFindsItWhereItIsNot) {
  const CampaignRun run("mc_adaptive.yaml", {"campaign.batches=1"});
  for (const char* variant : {"right", "right_adaptive", "right_classic", "small_adaptive",
                              "large_adaptive", "small_classic", "large_classic"})
    EXPECT_EQ(run.done(variant), kPaired) << variant;
  EXPECT_LE(run.ratio("right_adaptive", "right", kPosition), 1.03);
  EXPECT_LE(run.ratio("small_adaptive", "small", kPosition), 0.88);
  EXPECT_LE(nees(run, "small_adaptive") / nees(run, "small"), 0.5);
  EXPECT_LE(run.ratio("large_adaptive", "large", kPosition), 1.0);
}

TEST(NoiseAdaptation, FollowsASensorThatBecomesNoisy) {
  const CampaignRun run("mc_adaptive_step.yaml", {"campaign.batches=1"});
  for (std::size_t point = 0; point < 4; ++point)
    EXPECT_EQ(run.done("adaptive", point), kPaired) << point;
  const std::size_t throughout = 1;
  EXPECT_LE(run.ratio("adaptive", "fixed", kPosition, throughout), 0.88);
  EXPECT_LE(nees(run, "adaptive", throughout) / nees(run, "fixed", throughout), 0.5);
}

TEST(NoiseAdaptation, WithTheRightShapeComesCloseToTheOracle) {
  const CampaignRun run("mc_adaptive_distance.yaml", {"campaign.batches=1"});
  for (const char* variant : {"adaptive", "shaped", "oracle"})
    EXPECT_EQ(run.done(variant), kPaired) << variant;
  EXPECT_LE(run.ratio("shaped", "oracle", kPosition), 1.05);
}

TEST(NoiseAdaptation, LocalizesThroughANoisyStretchAndFindsItsSigma) {
  Scenario scenario = webmap();
  scenario.faults.noise_step = {true, 20.0, 50.0, 3.0};
  const auto figures = localize(scenario,
                                {{"adaptive", told(scenario, "residual")},
                                 {"classic", told(scenario, "classic")},
                                 {"fixed", told(scenario, "off")}},
                                kPaired);
  const LocalizationFigures& adaptive = figures.at("adaptive");
  for (const auto& [name, one] : figures)
    std::printf("%s rmse %.4f m nees %.2f failures %d\n", name.c_str(), one.rmse_position, one.nees,
                one.failures);
  EXPECT_LE(adaptive.rmse_position / figures.at("fixed").rmse_position, 0.92);
  EXPECT_LE(adaptive.nees, 3.5);
  EXPECT_EQ(adaptive.failures, 0);
  // Five observations a second: at the end of the noisy stretch, 30 s after the step, and 30 s
  // later.
  const auto at = [&](double time) {
    return adaptive.sigma_range.at(static_cast<std::size_t>(std::lround(time / 0.2)));
  };
  std::printf("sigma before %.4f at the end of the stretch %.4f, 30 s later %.4f\n", at(19.8),
              at(49.8), at(79.8));
  EXPECT_NEAR(at(19.8), 0.2, 0.15 * 0.2);
  EXPECT_NEAR(at(49.8), 0.6, 0.15 * 0.6);
  EXPECT_NEAR(at(79.8), 0.2, 0.15 * 0.2);
}
