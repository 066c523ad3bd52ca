// Runs in space, adapted noise and events on disk: trajectory.csv, trajectory.tum, run.json.

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include <libslam/result/recorded_run.hpp>
#include <libslam/result/recorder.hpp>

#include "spatial_run.hpp"

namespace libslam {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// With noise that drifts and three events, two of them in one step.
sample::Run adaptive_run(int steps) {
  sample::Run run = sample::make_spatial_run(steps, 30);
  for (StepRecord& step : run.steps) {
    const double k = static_cast<double>(step.index);
    step.noise = {{"pixel", 1.0 + 0.01 * k, 1.0}, {"disparity", 0.5 / (1.0 + k), 0.7}};
    if (step.index == 10) step.event = "disturbance";
    if (step.index == 14) step.event = "lost+relocalized";
  }
  return run;
}

RunSummary record(const fs::path& directory, const sample::Run& run, RunSummary summary = {}) {
  RecorderOptions options;
  options.directory = directory;
  options.events = true;
  Recorder recorder(options);
  for (const StepRecord& step : run.steps) recorder.record(step);
  return recorder.finish(std::move(summary), run.map, run.truth, LandmarkIdentity::known);
}

TEST(SpatialRecord, ReadsBackBitForBit) {
  const sample::TemporaryFolder folder("spatial");
  const sample::Run run = adaptive_run(30);
  record(folder.path() / "run", run);
  TrajectoryReader reader(folder.path() / "run" / "trajectory.csv");
  EXPECT_TRUE(reader.columns().spatial && reader.columns().events);
  EXPECT_EQ(reader.columns().calibration, std::vector<std::string>{"bias_x"});
  EXPECT_EQ(reader.columns().noise, (std::vector<std::string>{"pixel", "disparity"}));
  StepRecord back;
  for (const StepRecord& step : run.steps) {
    ASSERT_TRUE(reader.next(back));
    EXPECT_EQ(back.time, step.time);
    EXPECT_EQ(back.spatial->pose.position, step.spatial->pose.position);
    EXPECT_EQ(back.spatial->pose.rotation.coeffs(), step.spatial->pose.rotation.coeffs());
    const Eigen::Matrix<double, 6, 6> symmetric = step.spatial->cov.selfadjointView<Eigen::Upper>();
    EXPECT_EQ(back.spatial->cov, symmetric);
    EXPECT_EQ(back.pose, step.pose);
    EXPECT_LT((back.cov - step.cov).norm(), 1e-15);
    EXPECT_EQ(back.nis, step.nis);
    EXPECT_EQ(back.calibration[0].sigma, step.calibration[0].sigma);
    EXPECT_EQ(back.noise[1].sigma, step.noise[1].sigma);
    EXPECT_EQ(back.event, step.event);
  }
  EXPECT_FALSE(reader.next(back));
}

TEST(SpatialRecord, HeaderNamesEveryColumn) {
  std::string text;
  append_trajectory_header(text, columns_of(adaptive_run(1).steps[0], true));
  EXPECT_EQ(text,
            "time,step,x,y,z,qx,qy,qz,qw,"
            "cov_xx,cov_xy,cov_xz,cov_xrx,cov_xry,cov_xrz,cov_yy,cov_yz,cov_yrx,cov_yry,cov_yrz,"
            "cov_zz,cov_zrx,cov_zry,cov_zrz,cov_rxrx,cov_rxry,cov_rxrz,cov_ryry,cov_ryrz,cov_rzrz,"
            "nis,nis_dof,accepted,gated,ambiguous,new_landmarks,"
            "bias_x,sigma_bias_x,noise_pixel,noise_disparity,event\n");
}

TEST(SpatialRecord, TumHoldsHeightAndOrientation) {
  std::string text;
  append_tum_row(text, 2.5, SpatialPose{{1, -2, 3.25}, {0.5, -0.5, 0.5, -0.5}});
  EXPECT_EQ(text,
            "2.500000000 1.000000000 -2.000000000 3.250000000 -0.500000000 0.500000000 "
            "-0.500000000 0.500000000\n");
}

TEST(SpatialRecord, TheSummaryHoldsPoseNoiseEventsAndTheComparisonInSpace) {
  const sample::TemporaryFolder folder("spatial");
  const sample::Run run = adaptive_run(60);
  const fs::path directory = folder.path() / "run";
  const RunSummary summary = record(directory, run);
  EXPECT_FALSE(summary.result.pose);
  EXPECT_EQ(summary.result.pose3d->position, run.steps.back().spatial->pose.position);
  ASSERT_EQ(summary.result.noise.size(), 2u);
  EXPECT_EQ(summary.result.noise[0].sigma, run.steps.back().noise[0].sigma);
  EXPECT_EQ(summary.result.noise[1].configured, 0.7);
  EXPECT_EQ(*summary.health.disturbances, 1);
  ASSERT_EQ(summary.health.events.size(), 3u);
  EXPECT_EQ(summary.health.events[1].what, "lost");
  EXPECT_EQ(summary.health.events[2].what, "relocalized");
  for (const std::size_t one : {1u, 2u}) {
    EXPECT_EQ(summary.health.events[one].step, 14);
    EXPECT_EQ(summary.health.events[one].time, run.steps[14].time);
  }
  EXPECT_TRUE(summary.truth->path->rotation);
  EXPECT_EQ(summary.truth->nees->dof, 6);
  const RecordedRun back = read_recorded_run(directory);
  EXPECT_EQ(back.path.spatial.size(), 60u);
  EXPECT_EQ(to_json_text(back.summary), content(directory / "run.json"));
  EXPECT_EQ(compare_with_truth(back, run.truth, LandmarkIdentity::known).path->raw->rmse_m,
            summary.truth->path->raw->rmse_m);
}

TEST(SpatialRecord, ARunInAKnownMapSaysSoAndIsNotPlaced) {
  const sample::TemporaryFolder folder("spatial");
  const sample::Run run = sample::make_spatial_run(60, 31, false);
  RunSummary summary;
  summary.result.placement = Placement::none;
  summary = record(folder.path() / "run", run, summary);
  const RecordedRun back = read_recorded_run(folder.path() / "run");
  EXPECT_EQ(back.summary.result.placement, Placement::none);
  const auto raw = [&](std::optional<Placement> placement) {
    return compare_with_truth(back, run.truth, LandmarkIdentity::known, {}, placement)
        .path->raw->rmse_m;
  };
  EXPECT_EQ(raw(std::nullopt), summary.truth->path->raw->rmse_m);
  EXPECT_EQ(raw(Placement::none), raw(std::nullopt));
  EXPECT_NE(raw(Placement::first), raw(std::nullopt));
}

TEST(SpatialRecord, WithoutAdaptationAndEventsThereAreNoColumnsForThem) {
  std::string planar, row;
  append_trajectory_header(planar, columns_of(sample::make_run(1, 1).steps[0]));
  EXPECT_EQ(planar.find("noise_"), std::string::npos);
  EXPECT_EQ(planar.find("event"), std::string::npos);
  const sample::TemporaryFolder folder("spatial");
  RecorderOptions options;
  options.directory = folder.path() / "run";
  Recorder recorder(options);
  const sample::Run run = sample::make_run(5, 2);
  for (const StepRecord& step : run.steps) recorder.record(step);
  EXPECT_FALSE(
      recorder.finish({}, run.map, run.truth, LandmarkIdentity::known).health.disturbances);
}

TEST(SpatialRecord, RowsThatDoNotFitTheHeaderAreRefused) {
  const sample::TemporaryFolder folder("spatial");
  const sample::Run run = adaptive_run(2);
  RecorderOptions options;
  options.directory = folder.path() / "run";
  options.events = true;
  Recorder recorder(options);
  recorder.record(run.steps[0]);
  const auto refuses = [&](auto&& spoil) {
    StepRecord step = run.steps[1];
    spoil(step);
    EXPECT_THROW(recorder.record(step), std::invalid_argument);
  };
  refuses([](StepRecord& s) { s.spatial.reset(); });
  refuses([](StepRecord& s) { s.noise.pop_back(); });
  refuses([](StepRecord& s) { s.noise[0].sigma = std::nan(""); });
  refuses([](StepRecord& s) { s.spatial->cov(5, 5) = std::nan(""); });
  refuses([](StepRecord& s) { s.event = "lost, then found"; });
  refuses([](StepRecord& s) { s.event = "two\nlines"; });
}

TEST(SpatialRecord, EventsAreCountedBeyondThoseThatAreListed) {
  StepStatistics statistics;
  StepRecord step;
  step.event = "disturbance";
  constexpr auto kMany = static_cast<std::int64_t>(StepStatistics::kMostEvents) + 50;
  for (std::int64_t i = 0; i < kMany; ++i) statistics.add(step);
  EXPECT_EQ(statistics.disturbances(), kMany);
  EXPECT_EQ(statistics.events().size(), StepStatistics::kMostEvents);
}

}  // namespace
}  // namespace libslam
