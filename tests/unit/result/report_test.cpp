#include <fstream>

#include <gtest/gtest.h>

#include <libslam/result/recorder.hpp>
#include <libslam/result/report.hpp>
#include <libslam/result/report_data.hpp>

#include "sample_run.hpp"

namespace libslam {
namespace {

/// A recorded run and everything make_report wants to know of it.
class ReportTest : public testing::Test {
 protected:
  void record(const sample::Run& run) {
    run_ = run;
    RecorderOptions options;
    options.directory = folder_.path() / "run";
    options.force = true;
    options.report = false;
    Recorder recorder(options);
    for (const StepRecord& step : run.steps) recorder.record(step);
    summary_ = recorder.finish(summary_, run.map, run.truth, LandmarkIdentity::known);
    path_ = read_estimated_path(csv());
    step_times_ = recorder.statistics().step_times();
  }
  std::filesystem::path csv() const { return folder_.path() / "run" / "trajectory.csv"; }
  ReportInput input() const { return {summary_, run_.map, path_, csv(), run_.truth, step_times_}; }
  std::filesystem::path fake_library(const std::string& text) const {
    std::ofstream(folder_.path() / "d3.min.js") << text;
    return folder_.path();
  }

  sample::TemporaryFolder folder_{"report"};
  sample::Run run_;
  RunSummary summary_;
  std::vector<EstimatedPose> path_;
  SeriesEnvelope step_times_{1, 2};
};

void expect_no_network(const std::string& page) {
  EXPECT_NE(
      page.find("default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'\""),
      std::string::npos);
  for (const char* loader : {"src=", "href=", "@import", "url(http", "<link", "<iframe", "<img"})
    EXPECT_EQ(page.find(loader), std::string::npos) << loader;
}

bool has(const std::string& page, const std::string& text) {
  return page.find(text) != std::string::npos;
}

TEST_F(ReportTest, CarriesTheLibraryAndLoadsNothing) {
  record(sample::make_run(300, 14));
  const std::string page = make_report(input(), fake_library("/* the library */ var d3 = {};"));
  EXPECT_TRUE(has(page, "<script>/* the library */ var d3 = {};</script>"));
  EXPECT_TRUE(has(page, "id=\"data\""));
  EXPECT_FALSE(has(page, "LIBSLAM_JS_DIR"));
  EXPECT_FALSE(has(page, "{{"));
  expect_no_network(page);
}

TEST_F(ReportTest, WithoutTheLibraryThereAreStillDrawingsAndAHint) {
  record(sample::make_run(300, 15));
  const std::string page = make_report(input(), folder_.path() / "nowhere");
  EXPECT_TRUE(has(page, "libjs-d3"));
  EXPECT_TRUE(has(page, "<polyline class=\"estimate-line\""));
  EXPECT_FALSE(has(page, "<script"));
  expect_no_network(page);
}

TEST_F(ReportTest, WallsAndTheSmoothedPathStandInTheFrameOfTheTruth) {
  sample::Run run = sample::make_run(50, 18);
  for (TrueLandmark& landmark : run.truth.landmarks) landmark.position[0] += 100.0;
  for (Eigen::Vector3d& pose : run.truth.path.poses) pose.x() += 100.0;  // of another origin
  run.map.add({900, "line", Eigen::Vector2d(0.0, 12.0), 1e-4 * Eigen::Matrix2d::Identity(), 5,
               Extent{-2.0, 3.0}});
  record(run);
  const Trajectory smoothed{{run.steps[0].time}, {run.steps[0].pose}, {}};
  ReportInput shown = input();
  shown.smoothed = &smoothed;
  const auto data = make_report_data(shown);
  ASSERT_EQ(data["map"]["walls"].size(), 1u);
  const auto& wall = data["map"]["walls"][0];
  EXPECT_NEAR(wall[0].get<double>(), 112.0, 1e-3);
  EXPECT_NEAR(wall[2].get<double>(), 112.0, 1e-3);
  EXPECT_NEAR(wall[3].get<double>() - wall[1].get<double>(), 5.0, 1e-3);
  EXPECT_EQ(wall[4], 900);
  EXPECT_NEAR(data["map"]["smoothed"]["x"][0].get<double>(), 100.0, 1e-3);
  const std::string page = make_report(shown, folder_.path() / "nowhere");
  EXPECT_TRUE(has(page, "<line class=\"wall\""));
  EXPECT_TRUE(has(page, "class=\"smoothed-line\""));
}

TEST_F(ReportTest, SixtyThousandStepsStayBelowThreeMegabytes) {
  record(sample::make_run(60000, 16));
  const auto folder = plotting_library_folder();
  const std::string page = make_report(input(), folder);
  if (!has(page, "id=\"data\"")) GTEST_SKIP() << "no plotting library in " << folder;
  EXPECT_LT(page.size(), 3'000'000u);
  RecordProperty("page_bytes", static_cast<int>(page.size()));
}

TEST_F(ReportTest, TextOfTheLogCannotBecomeMarkup) {
  sample::Run run = sample::make_run(20, 17);
  for (StepRecord& step : run.steps) step.calibration[0].name = "</script><b>";
  summary_.input.warnings = {"sensor <img src=x> & \"quote\" \xff"};
  summary_.input.file = "<a href=http://x>.rawlog";
  record(run);
  const std::string page = make_report(input(), fake_library("var d3;"));
  EXPECT_TRUE(has(page, "sensor &lt;img"));
  EXPECT_FALSE(has(page, "<b>"));
  EXPECT_FALSE(has(page, "<img"));
  EXPECT_FALSE(has(page, "<a href"));
}

TEST_F(ReportTest, DataAreInTheFrameOfTheTruthAndOfEqualLength) {
  sample::Run run = sample::make_run(5000, 18);
  const mrpt::math::TPose2D T(100, -50, 1.0);
  for (Eigen::Vector3d& pose : run.truth.path.poses) pose = transform_pose(T, pose);
  record(run);
  const auto data = make_report_data(input());
  const Eigen::Vector2d start = run.truth.path.poses.front().head<2>();
  EXPECT_NEAR(data["map"]["path"]["x"][0].get<double>(), start.x(), 1e-3);
  EXPECT_NEAR(data["map"]["path"]["y"][0].get<double>(), start.y(), 1e-3);
  EXPECT_EQ(data["map"]["landmarks"].size(), 24u);
  ASSERT_EQ(data["plots"].size(), 5u);
  for (const auto& plot : data["plots"])
    for (const auto& panel : plot["panels"]) {
      EXPECT_EQ(panel["low"].size(), plot["t"].size());
      EXPECT_EQ(panel["high"].size(), plot["t"].size());
      if (panel.contains("band")) {
        EXPECT_EQ(panel["band"]["low"].size(), plot["t"].size());
      }
    }
}

TEST_F(ReportTest, WithoutTruthOnlyTheFilterSpeaks) {
  sample::Run run = sample::make_run(100, 19);
  run.truth = {};
  record(run);
  const auto data = make_report_data(input());
  EXPECT_TRUE(data["map"]["truth"]["x"].empty());
  EXPECT_EQ(data["plots"].size(), 3u);
  EXPECT_FALSE(has(make_report(input()), "NEES"));
}

}  // namespace
}  // namespace libslam
