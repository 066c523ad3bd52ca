#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <libslam/result/run_summary.hpp>

namespace libslam {
namespace {

RunSummary full_summary() {
  RunSummary s;
  s.program = "slam-run";
  s.version = "0.1.0";
  s.git = "abc";
  s.config_sha256 = "c0";
  s.input_sha256 = "1f";
  s.seed = 18446744073709551615u;
  s.threads = 2;
  s.exit_code = 5;
  s.status = "input partly unusable";
  s.input = {"data.rawlog", 100, 50, 50, 12.5, 1, 2, {"entry 3: negative range"}};
  s.result.pose.emplace(1, 2, 0.1);
  s.result.landmarks = 17;
  s.result.calibration = {{"scale_left", 1.04, 0.001, 1, 0.1, true}};
  s.timing = {3.5, 3.25, 50, StepTime{0.2, 0.1, 0.5, 3}, {{"predict", 0.5}}, 42.0, 3.5};
  s.health.nis_mean = 1.1;
  s.health.nis_in_95 = 0.9;
  s.health.disturbances = 0;
  s.truth.emplace();
  s.truth->path = {50, PathErrors::Position{1, 2, 3, 4, 5},
                   PathErrors::Position{.1, .2, .3, .4, .5}, PathErrors::Heading{.01, .02}};
  s.truth->relative = {10, 40, 1.5, 0.02};
  s.truth->nees = {49, 3.1, 2.4, .94, {3.0, std::nullopt, 3.2, 3.1}, .96};
  s.truth->map = {15, 2, 1, .05, .02};
  s.truth->calibration_error = {{"scale_left", 0.001}};
  return s;
}

TEST(RunSummary, ReadsBackToTheSameText) {
  const std::string text = to_json_text(full_summary());
  EXPECT_EQ(to_json_text(parse_run_summary(text, "run.json")), text);
  const std::string bare = to_json_text(RunSummary());
  EXPECT_EQ(to_json_text(parse_run_summary(bare, "run.json")), bare);
}

TEST(RunSummary, KeysAreThoseOfTheContract) {
  const auto json = nlohmann::json::parse(to_json_text(full_summary()));
  for (const char* pointer : {"/program",
                              "/version",
                              "/git",
                              "/config_sha256",
                              "/input_sha256",
                              "/seed",
                              "/threads",
                              "/exit_code",
                              "/status",
                              "/input/entries",
                              "/input/actions",
                              "/input/observations",
                              "/input/duration_s",
                              "/input/skipped",
                              "/input/repaired",
                              "/input/warnings/0",
                              "/result/pose/2",
                              "/result/landmarks",
                              "/result/calibration/scale_left/mean",
                              "/result/calibration/scale_left/sigma",
                              "/result/calibration/scale_left/observable",
                              "/timing/wall_s",
                              "/timing/cpu_s",
                              "/timing/steps",
                              "/timing/step_ms/mean",
                              "/timing/step_ms/p50",
                              "/timing/step_ms/p95",
                              "/timing/step_ms/max",
                              "/timing/phases/predict",
                              "/timing/peak_rss_mb",
                              "/timing/realtime_factor",
                              "/health/nis_mean",
                              "/health/nis_in_95",
                              "/health/disturbances",
                              "/truth/ate_rmse_m",
                              "/truth/ate_rmse_aligned_m",
                              "/truth/ate_mean_m",
                              "/truth/ate_max_m",
                              "/truth/rmse_x_m",
                              "/truth/rmse_y_m",
                              "/truth/rmse_heading_rad",
                              "/truth/max_heading_rad",
                              "/truth/rpe_trans_percent",
                              "/truth/nees_mean",
                              "/truth/nees_in_95",
                              "/truth/nees_coverage_95",
                              "/truth/map_rmse_m",
                              "/truth/map_rmse_aligned_m",
                              "/truth/calibration_error/scale_left"})
    EXPECT_TRUE(json.contains(nlohmann::json::json_pointer(pointer))) << pointer;
}

TEST(RunSummary, WhatIsNotApplicableIsAbsent) {
  const auto json = nlohmann::json::parse(to_json_text(RunSummary()));
  EXPECT_FALSE(json.contains("truth") || json.contains("health") || json.contains("seed"));
  EXPECT_FALSE(json["result"].contains("pose") || json["timing"].contains("step_ms") ||
               json["timing"].contains("phases"));
}

TEST(RunSummary, NonFiniteNumbersAndBrokenTextStayValidJson) {
  RunSummary s = full_summary();
  s.truth->nees->mean = std::nan("");
  s.input.warnings = {"label \xff\xfe"};
  const std::string text = to_json_text(s);
  EXPECT_TRUE(nlohmann::json::parse(text)["truth"]["nees_mean"].is_null());
  EXPECT_NO_THROW(parse_run_summary(text, "run.json"));
}

TEST(RunSummary, BadFilesNameThemselves) {
  for (const char* text :
       {"", "[]", "{\"threads\": \"two\"}", "{\"input\": 3}", "{\"result\":{\"pose\":[1]}}"}) {
    try {
      parse_run_summary(text, "some/run.json");
      FAIL() << text;
    } catch (const std::runtime_error& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("some/run.json: ")) << error.what();
    }
  }
  EXPECT_THROW(read_run_summary("/nonexistent/run.json"), std::runtime_error);
}

}  // namespace
}  // namespace libslam
