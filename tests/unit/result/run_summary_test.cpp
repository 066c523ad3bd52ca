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

RunSummary spatial_summary() {
  RunSummary s = full_summary();
  s.result.pose.reset();
  s.result.pose3d = {{1, 2, 3}, {0.5, -0.5, 0.5, 0.5}};
  s.result.placement = Placement::none;
  s.result.noise = {{"range", 0.2, 0.1}};
  s.health.events = {{12.5, 40, "disturbance"}, {13.0, 45, "relocalized"}};
  s.truth->path->heading.reset();
  s.truth->path->raw->rmse_z_m = 6;
  s.truth->path->aligned->rmse_z_m = .6;
  s.truth->path->rotation = {.03, .04};
  s.truth->path->drift_percent = 1.25;
  s.truth->nees->dof = 6;
  return s;
}

TEST(RunSummary, KeysOfARunInSpaceReadBack) {
  const std::string text = to_json_text(spatial_summary());
  EXPECT_EQ(to_json_text(parse_run_summary(text, "run.json")), text);
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["result"]["pose3d"],
            nlohmann::json::array({1.0, 2.0, 3.0, -0.5, 0.5, 0.5, 0.5}));  // w last
  EXPECT_EQ(json["result"]["placement"], "none");
  EXPECT_EQ(json["result"]["noise"]["range"]["configured"], 0.1);
  EXPECT_EQ(json["health"]["events"][1]["what"], "relocalized");
  EXPECT_EQ(json["health"]["events"][1]["step"], 45);
  EXPECT_EQ(json["truth"]["rmse_rotation_rad"], 0.03);
  EXPECT_EQ(json["truth"]["max_rotation_rad"], 0.04);
  EXPECT_EQ(json["truth"]["rmse_z_aligned_m"], 0.6);
  EXPECT_EQ(json["truth"]["drift_percent"], 1.25);
  EXPECT_EQ(json["truth"]["nees_dof"], 6);
  EXPECT_FALSE(json["truth"].contains("rmse_heading_rad") || json["result"].contains("pose"));
  const auto planar = nlohmann::json::parse(to_json_text(full_summary()));
  for (const char* pointer :
       {"/result/pose3d", "/result/placement", "/result/noise", "/health/events",
        "/truth/rmse_rotation_rad", "/truth/rmse_z_m", "/truth/drift_percent", "/truth/nees_dof"})
    EXPECT_FALSE(planar.contains(nlohmann::json::json_pointer(pointer))) << pointer;
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
