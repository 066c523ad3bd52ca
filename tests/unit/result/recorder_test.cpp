#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include <libslam/result/recorder.hpp>

#include "sample_run.hpp"

namespace libslam {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

RunSummary record_run(const fs::path& directory, const sample::Run& run,
                      RecorderOptions options = {}) {
  options.directory = directory;
  Recorder recorder(options);
  for (const StepRecord& step : run.steps) recorder.record(step);
  return recorder.finish({}, run.map, run.truth, LandmarkIdentity::known);
}

TEST(Recorder, LeavesACompleteRunDirectory) {
  const sample::TemporaryFolder folder("recorder");
  const sample::Run run = sample::make_run(200, 8);
  const RunSummary summary = record_run(folder.path() / "a" / "run", run);
  const fs::path directory = folder.path() / "a" / "run";
  for (const char* name :
       {"trajectory.csv", "trajectory.tum", "map.csv", "run.json", "report.html"})
    EXPECT_GT(fs::file_size(directory / name), 100u) << name;
  EXPECT_EQ(std::distance(fs::directory_iterator(directory), {}), 5);  // no temporary files
  EXPECT_EQ(content(directory / "run.json"), to_json_text(summary));
  EXPECT_EQ(*summary.result.pose, run.steps.back().pose);
  EXPECT_EQ(summary.result.landmarks, 24);
  EXPECT_EQ(summary.result.calibration.size(), 2u);
  ASSERT_TRUE(summary.truth && summary.truth->path && summary.truth->map && summary.truth->nees);
  EXPECT_EQ(summary.truth->path->poses, 200);
}

TEST(Recorder, TheSameStepsGiveTheSameBytesWhateverTheClockSays) {
  const sample::TemporaryFolder folder("recorder");
  sample::Run run = sample::make_run(100, 9);
  record_run(folder.path() / "a", run);
  for (StepRecord& step : run.steps) step.step_ms *= 7;
  record_run(folder.path() / "b", run);
  for (const char* name : {"trajectory.csv", "trajectory.tum", "map.csv"})
    EXPECT_EQ(content(folder.path() / "a" / name), content(folder.path() / "b" / name)) << name;
}

TEST(Recorder, RowsAreOnDiskBeforeTheRunEnds) {
  const sample::TemporaryFolder folder("recorder");
  const sample::Run run = sample::make_run(20, 10);
  Recorder recorder({folder.path() / "run"});
  for (std::size_t i = 0; i < 13; ++i) recorder.record(run.steps[i]);
  EXPECT_EQ(read_estimated_path(folder.path() / "run" / "trajectory.csv").size(), 13u);
}

TEST(Recorder, ThinningKeepsUpdatesAndTheLastStep) {
  const sample::TemporaryFolder folder("recorder");
  sample::Run run = sample::make_run(100, 11);
  for (StepRecord& step : run.steps) step.nis_dof = step.index == 57 ? 2 : 0;
  RecorderOptions options;
  options.trajectory_period_s = 0.95;  // steps are 0.1 s apart
  record_run(folder.path() / "run", run, options);
  std::vector<std::int64_t> steps;
  for (const EstimatedPose& pose : read_estimated_path(folder.path() / "run" / "trajectory.csv"))
    steps.push_back(pose.step);
  EXPECT_EQ(steps, (std::vector<std::int64_t>{0, 10, 20, 30, 40, 50, 57, 67, 77, 87, 97, 99}));
}

TEST(Recorder, ARunWithoutStepsIsStillAValidDirectory) {
  const sample::TemporaryFolder folder("recorder");
  const RunSummary summary = record_run(folder.path() / "run", {});
  EXPECT_FALSE(summary.result.pose);
  EXPECT_TRUE(read_estimated_path(folder.path() / "run" / "trajectory.csv").empty());
  EXPECT_TRUE(fs::exists(folder.path() / "run" / "report.html"));
}

TEST(Recorder, RefusesADirectoryWithContentUnlessForced) {
  const sample::TemporaryFolder folder("recorder");
  const fs::path directory = folder.path() / "run";
  const sample::Run run = sample::make_run(10, 12);
  fs::create_directories(directory);
  EXPECT_NO_THROW(record_run(directory, run));  // existing and empty
  std::ofstream(directory / "notes.txt") << "mine";
  std::ofstream(directory / "scene.3Dscene") << "of the old run";
  try {
    Recorder recorder({directory});
    FAIL() << "took a directory with content";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(directory.string()), std::string::npos);
  }
  EXPECT_TRUE(fs::exists(directory / "run.json"));
  RecorderOptions options;
  options.force = true;
  record_run(directory, run, options);
  EXPECT_EQ(content(directory / "notes.txt"), "mine");
  EXPECT_FALSE(fs::exists(directory / "scene.3Dscene"));
}

TEST(Recorder, UnwritableOutputNamesThePath) {
  const sample::TemporaryFolder folder("recorder");
  std::ofstream(folder.path() / "file") << "x";
  for (const fs::path& directory :
       {folder.path() / "file", folder.path() / "file" / "run", fs::path("/proc/libslam-run")}) {
    try {
      Recorder recorder({directory});
      FAIL() << directory;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(directory.string()), std::string::npos)
          << error.what();
    }
  }
}

TEST(Recorder, ChangingCalibrationParametersAreRefused) {
  const sample::TemporaryFolder folder("recorder");
  const sample::Run run = sample::make_run(3, 13);
  Recorder recorder({folder.path() / "run"});
  recorder.record(run.steps[0]);
  StepRecord step = run.steps[1];
  step.calibration.pop_back();
  EXPECT_THROW(recorder.record(step), std::invalid_argument);
}

TEST(Recorder, AStepThatIsNotFiniteIsRefusedAndTheRestStays) {
  const sample::TemporaryFolder folder("recorder");
  const sample::Run run = sample::make_run(3, 14);
  Recorder recorder({folder.path() / "run"});
  recorder.record(run.steps[0]);
  StepRecord step = run.steps[1];
  step.cov(1, 1) = std::nan("");
  EXPECT_THROW(recorder.record(step), std::invalid_argument);
  recorder.finish({}, run.map, run.truth, LandmarkIdentity::known);
  EXPECT_EQ(read_estimated_path(folder.path() / "run" / "trajectory.csv").size(), 1u);
}

}  // namespace
}  // namespace libslam
