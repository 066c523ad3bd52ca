// The report of runs in space, with adapted noise, events and pictures.

#include <cstdint>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <mrpt/system/string_utils.h>

#include <libslam/result/recorder.hpp>
#include <libslam/result/report.hpp>
#include <libslam/result/report_data.hpp>

#include "spatial_run.hpp"

namespace libslam {
namespace {

const std::string kPng("\x89PNG\r\n\x1a\n and \0 any bytes", 24);

class SpatialReportTest : public testing::Test {
 protected:
  void record(const sample::Run& run) {
    run_ = run;
    RecorderOptions options{folder_.path() / "run", true, 0.0, false, true};
    Recorder recorder(options);
    for (const StepRecord& step : run.steps) recorder.record(step);
    summary_ = recorder.finish({}, run.map, run.truth, LandmarkIdentity::known);
    path_ = read_path(folder_.path() / "run" / "trajectory.csv");
  }
  ReportInput input() const {
    return {summary_,   run_.map,    path_,    folder_.path() / "run" / "trajectory.csv",
            run_.truth, step_times_, pictures_};
  }
  nlohmann::ordered_json plot(const std::string& title) const {
    const auto data = make_report_data(input());
    for (const auto& plot : data["plots"])
      if (plot["title"] == title) return plot;
    return {};
  }

  sample::TemporaryFolder folder_{"spatial_report"};
  sample::Run run_;
  RunSummary summary_;
  EstimatedPath path_;
  SeriesEnvelope step_times_{1, 2};
  std::vector<ReportPicture> pictures_;
};

TEST_F(SpatialReportTest, TheViewsAreThoseOfTheFrameOfTheTruth) {
  sample::Run run = sample::make_spatial_run(400, 40);
  sample::move_truth(run, Eigen::Translation3d(100, -50, 30) * sample::rotation({0.5, 0.2, 1.0}));
  record(run);
  const auto data = make_report_data(input());
  const Eigen::Vector3d start = run.truth.path.spatial.front().position;
  ASSERT_TRUE(data.contains("side"));
  EXPECT_NEAR(data["map"]["path"]["x"][0].get<double>(), start.x(), 1e-3);
  EXPECT_NEAR(data["map"]["path"]["y"][0].get<double>(), start.y(), 1e-3);
  EXPECT_NEAR(data["side"]["path"]["x"][0].get<double>(), start.x(), 1e-3);
  EXPECT_NEAR(data["side"]["path"]["y"][0].get<double>(), start.z(), 1e-3);
  for (const char* view : {"map", "side"}) {
    EXPECT_EQ(data[view]["landmarks"].size(), 20u);
    EXPECT_EQ(data[view]["true_landmarks"].size(), 20u);
    // Landmarks of covariance .05^2 I: round from every side.
    EXPECT_NEAR(data[view]["landmarks"][3][2].get<double>(), 0.0025, 1e-8);
    EXPECT_NEAR(data[view]["landmarks"][3][3].get<double>(), 0.0, 1e-8);
    EXPECT_NEAR(data[view]["landmarks"][3][4].get<double>(), 0.0025, 1e-8);
  }
  const double height = run.truth.landmarks[3].position.z();
  EXPECT_NEAR(data["side"]["true_landmarks"][3][1].get<double>(), height, 1e-3);
}

TEST_F(SpatialReportTest, ErrorsHaveSixPanelsAndNeesItsBand) {
  record(sample::make_spatial_run(400, 41));
  EXPECT_EQ(plot("Position error")["panels"].size(), 3u);
  EXPECT_EQ(plot("Rotation error")["panels"].size(), 3u);
  const auto nees = plot("Consistency of the pose (NEES)")["panels"][0];
  EXPECT_EQ(nees["level"]["value"], 6.0);
  EXPECT_NEAR(nees["interval"]["low"].get<double>(), 1.23734, 1e-4);  // chi-square tables, 6 dof
  EXPECT_NEAR(nees["interval"]["high"].get<double>(), 14.4494, 1e-3);
  const std::string page = make_report(input());
  for (const char* text : {"NEES mean (ideal 6)", "NEES median (ideal 5.35)", "rotation max",
                           "roll, pitch, yaw", "drift at the end"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
}

TEST_F(SpatialReportTest, AFlatRunHasNoViewFromTheSide) {
  sample::Run run = sample::make_spatial_run(50, 42);
  run.truth = {};
  run.map = {};
  for (StepRecord& step : run.steps) step.spatial->pose.position.z() = 3.0;
  record(run);
  EXPECT_FALSE(make_report_data(input()).contains("side"));
}

TEST_F(SpatialReportTest, NoiseIsDrawnAgainstItsConfigurationAndEventsAreMarked) {
  sample::Run run = sample::make_spatial_run(100, 43);
  for (StepRecord& step : run.steps)
    step.noise = {{"pixel", 1.0 + 0.01 * static_cast<double>(step.index), 1.5}};
  run.steps[30].event = "disturbance <b>";
  record(run);
  const auto data = make_report_data(input());
  const auto noise = plot("Adapted noise");
  EXPECT_EQ(noise["panels"][0]["level"]["value"], 1.5);
  EXPECT_NEAR(noise["panels"][0]["high"].back().get<double>(), 1.99, 1e-6);
  ASSERT_EQ(data["events"].size(), 1u);
  EXPECT_NEAR(data["events"][0]["t"].get<double>(), 3.0, 1e-6);
  EXPECT_NEAR(data["map"]["events"][0][0].get<double>(), path_.poses[30].pose.x(), 1e-4);
  EXPECT_NEAR(data["side"]["events"][0][1].get<double>(), path_.spatial[30].pose.position.z(),
              1e-4);
  const std::string page = make_report(input());
  EXPECT_NE(page.find("1.99 (configured 1.5)"), std::string::npos);
  EXPECT_EQ(page.find("<b>"), std::string::npos);
}

TEST_F(SpatialReportTest, PicturesAreInThePageAndNothingElseMayLoad) {
  record(sample::make_spatial_run(20, 44));
  pictures_ = {{"Matches <of> frame 7", kPng}};
  const std::string page = make_report(input());
  EXPECT_NE(page.find("script-src 'unsafe-inline'; img-src data:\""), std::string::npos);
  EXPECT_NE(page.find("<h2>Matches &lt;of&gt; frame 7</h2>"), std::string::npos);
  const std::string opening = "src=\"data:image/png;base64,";
  const std::size_t begin = page.find(opening) + opening.size();
  std::vector<std::uint8_t> bytes;
  ASSERT_TRUE(mrpt::system::decodeBase64(page.substr(begin, page.find('"', begin) - begin), bytes));
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), kPng);
}

TEST_F(SpatialReportTest, WhatIsNoPictureIsRefused) {
  Recorder recorder({folder_.path() / "pictures"});
  EXPECT_THROW(recorder.add_picture({"matches", "GIF89a"}), std::invalid_argument);
  recorder.add_picture({"matches", kPng});
  recorder.finish({}, {}, {}, LandmarkIdentity::known);
  std::ifstream in(folder_.path() / "pictures" / "report.html");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(page.find("<h2>matches</h2>"), std::string::npos);
}

}  // namespace
}  // namespace libslam
