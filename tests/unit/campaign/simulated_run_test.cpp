#include <atomic>
#include <cmath>
#include <map>
#include <stdexcept>

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <libslam/campaign/simulated_run.hpp>
#include <libslam/pipeline/run.hpp>
#include <libslam/pipeline/simulated_drive.hpp>
#include <libslam/pipeline/simulation.hpp>
#include <libslam/state/planar_pose.hpp>

#include "campaign_fixture.hpp"

namespace libslam {
namespace {

using namespace test;

/// Without what the clock says.
std::vector<std::uint8_t> bytes_of(RunOutcome outcome) {
  for (VariantOutcome& variant : outcome.variants) variant.figures.erase("timing");
  return to_bytes(outcome);
}

TEST(SimulatedRun, SameTaskGivesTheSameBytesAndAnotherSeedOthers) {
  const CampaignPlan plan = small_plan(2);
  const auto first = bytes_of(run_task(plan, task_of(plan, 0)));
  EXPECT_EQ(bytes_of(run_task(plan, task_of(plan, 0))), first);
  EXPECT_NE(bytes_of(run_task(plan, task_of(plan, 1))), first);
}

TEST(SimulatedRun, FiltersDoNotDisturbEachOther) {
  const CampaignPlan both = small_plan(1);
  CampaignPlan alone = both;
  alone.points[0].variants.erase(alone.points[0].variants.begin());
  RunOutcome expected = run_task(both, task_of(both, 0));
  expected.variants.erase(expected.variants.begin());
  EXPECT_EQ(bytes_of(run_task(alone, task_of(alone, 0))), bytes_of(expected));
}

TEST(SimulatedRun, EqualsTheSameDriveThroughAFile) {
  const CampaignPlan plan = small_plan(1);
  const CampaignTask task = task_of(plan, 0);
  const VariantOutcome outcome = run_task(plan, task).variants.at(1);
  ASSERT_TRUE(outcome.done()) << outcome.status;

  const TemporaryDirectory directory;
  DriveRequest drive{plan.points[0].scenario, directory.path() / "a.rawlog", nullptr, {}};
  drive.scenario.seed = static_cast<int>(task.seed);
  simulate_drive(drive);
  RunRequest request;
  request.rawlog = drive.rawlog.string();
  request.parameters = plan.points[0].variants[1].parameters;
  request.parameters.output.report = false;
  request.directory = directory.path() / "run";
  std::vector<StepRecord> updates;
  request.on_step = [&](double, const StepRecord& step) {
    if (updates.empty() || step.accepted > 0 || step.new_landmarks > 0) updates.push_back(step);
  };
  run_rawlog(request);

  const auto simulator = make_simulator(plan.points[0].scenario, task.seed);
  std::map<std::int64_t, Eigen::Vector3d> truth;
  while (const auto step = simulator->next())
    truth[step->step.index] = relative_pose(simulator->start(), step->T_world_robot);
  ASSERT_EQ(outcome.series.times.size(), updates.size());
  ASSERT_GT(updates.size(), 10U);
  for (std::size_t k = 0; k < updates.size(); ++k) {
    const Eigen::Vector3d error = updates[k].pose - truth.at(updates[k].index);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      EXPECT_EQ(outcome.series.sigmas[i][k], std::sqrt(updates[k].cov(axis, axis)));
      if (axis < 2) {
        EXPECT_EQ(outcome.series.errors[i][k], error[axis]);
      }
    }
  }
}

/// Numbers of the observations of the first log that hold a sighting.
std::vector<std::size_t> observations_with_sightings(const CampaignPlan& plan) {
  std::vector<std::size_t> found;
  const auto simulator = make_simulator(plan.points[0].scenario, task_of(plan, 0).seed);
  std::size_t observation = 0;
  while (const auto step = simulator->next()) {
    if (!step->step.frame) continue;
    const auto seen =
        step->step.frame->getObservationByClass<mrpt::obs::CObservationBearingRange>();
    if (seen && !seen->sensedData.empty()) found.push_back(observation);
    ++observation;
  }
  return found;
}

// A filter that leaves out its hard moments must not look better for it.
TEST(SimulatedRun, EveryFilterIsJudgedAtEveryObservationUsedOrNot) {
  // Landmarks within 6 m are rare: many observations see none. The last filter uses none at all.
  const CampaignPlan plan =
      load_text(kSmallScenario + kTwoVariants +
                    "  mrpt: {engine: mrpt}\n  blind: {frontend: {max_range: 0.001}}\n",
                {"campaign.runs=1", "scenario.range_bearing.max_range=6", "scenario.drive.speed=5",
                 "scenario.drive.max_duration_s=10"});
  const RunOutcome outcome = run_task(plan, task_of(plan, 0));
  ASSERT_EQ(outcome.variants.size(), 4U);
  const auto seen = observations_with_sightings(plan);
  EXPECT_LT(seen.size(), 45U);
  for (std::size_t i = 0; i < 4; ++i) {
    const VariantOutcome& variant = outcome.variants[i];
    ASSERT_TRUE(variant.done()) << variant.status;
    ASSERT_EQ(variant.nees.size(), 51U);  // every .2 s from 0 to 10 s
    EXPECT_EQ(variant.sums.count, 51);
    std::vector<std::size_t> without;
    for (std::size_t k = 0; k < 51; ++k)
      if (!std::isfinite(variant.nees[k])) without.push_back(k);
    // The start is known. MRPT's class does not move before it knows a landmark, so that its P is
    // zero at its first update.
    const auto expected =
        i == 2 ? std::vector<std::size_t>{0, seen.front()} : std::vector<std::size_t>{0};
    EXPECT_EQ(without, expected) << i;
  }
  EXPECT_GT(outcome.variants[3].sums.x, 0.0);
}

TEST(CampaignPlan, MrptRefusesWhatItWouldIgnore) {
  const std::string variant = "  mrpt: {engine: mrpt, ";
  for (const char* ignored :
       {"calibration: {scale_left: {enabled: true}}", "filter: {initial_sigma_xy: 0.1}"})
    EXPECT_THROW(load_text(kSmallScenario + kTwoVariants + variant + ignored + "}\n"), ConfigError)
        << ignored;
}

TEST(SimulatedRun, RunBeyondTheLimitIsDiverged) {
  const CampaignPlan plan = load_text(kSmallScenario, {"campaign.diverged_beyond=0.001"});
  EXPECT_EQ(run_task(plan, task_of(plan, 0)).variants[0].status, "diverged");
}

TEST(SimulatedRun, FilterThatThrowsIsReportedAndTheOthersGoOn) {
  CampaignPlan plan = small_plan(1);
  plan.points[0].variants[0].parameters.motion.model = "hovercraft";  // no loader lets this pass
  const RunOutcome outcome = run_task(plan, task_of(plan, 0));
  EXPECT_TRUE(outcome.variants[0].failed());
  EXPECT_NE(outcome.variants[0].status.find("hovercraft"), std::string::npos);
  EXPECT_TRUE(outcome.variants[1].done());
}

TEST(SimulatedRun, DriveThatCannotBeDrivenThrows) {
  const CampaignPlan plan = load_text(
      kSmallScenario, {"scenario.drive.steering_limit_deg=0.5", "scenario.drive.max_duration_s=0"});
  EXPECT_THROW(run_task(plan, task_of(plan, 0)), std::runtime_error);
}

TEST(SimulatedRun, StopEndsARun) {
  const CampaignPlan plan = small_plan(1);
  const std::atomic<bool> stop{true};
  EXPECT_THROW(run_task(plan, task_of(plan, 0), &stop), std::runtime_error);
}

}  // namespace
}  // namespace libslam
