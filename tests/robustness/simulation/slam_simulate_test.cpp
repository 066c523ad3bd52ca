// What slam-simulate promises to people and scripts.

#include <chrono>
#include <filesystem>
#include <signal.h>
#include <support/program_run.hpp>
#include <thread>
#include <unistd.h>

#include <nlohmann/json.hpp>

namespace libslam {
namespace {

using namespace libslam::test;

const std::string kSimulate = LIBSLAM_SLAM_SIMULATE, kRun = LIBSLAM_SLAM_RUN;
const std::string kWebmap = LIBSLAM_CONFIG_DIR "/sim_webmap.yaml";
const std::string kShort = " --set drive.max_duration_s=5";

class SlamSimulate : public ProgramTest {
 protected:
  void expect_one_line(const Outcome& outcome, int code, const std::string& text) const {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  }
};

TEST_F(SlamSimulate, WritesTheFilesOfTheContractAndReproducesThem) {
  ASSERT_EQ(run(kSimulate + " " + kWebmap + " --seed 7 --out " + path("a") + kShort).code, 0);
  for (const char* ending : {".rawlog", ".truth.tum", ".truth.csv", ".landmarks.csv", ".truth.json",
                             ".scenario.yaml", ".filter.yaml"})
    EXPECT_TRUE(std::filesystem::exists(path("a") + ending)) << ending;
  const auto notes = nlohmann::json::parse(read_all(path("a.truth.json")));
  EXPECT_EQ(notes.at("seed"), 7);
  EXPECT_EQ(notes.at("calibration").at("scale_left"), 1.05);
  EXPECT_EQ(notes.at("scenario").at("drive.speed"), "3");
  // The scenario goes with its world: it works from another place.
  std::filesystem::create_directory(path("elsewhere"));
  for (const char* ending : {".landmarks.csv", ".way_points.csv", ".scenario.yaml"})
    std::filesystem::copy(path("a") + ending, path("elsewhere/a") + ending);
  ASSERT_EQ(
      run(kSimulate + " " + path("elsewhere/a.scenario.yaml") + " --out " + path("b.rawlog")).code,
      0);
  for (const char* ending : {".rawlog", ".truth.tum", ".truth.csv", ".landmarks.csv"})
    EXPECT_EQ(read_all(path("a") + ending), read_all(path("b") + ending)) << ending;
}

TEST_F(SlamSimulate, SlamRunFindsItsTruth) {
  ASSERT_EQ(run(kSimulate + " " + kWebmap + " --seed 7 --out " + path("a") +
                " --set drive.max_duration_s=60")
                .code,
            0);
  const Outcome outcome =
      run(kRun + " " + path("a.rawlog") + " --out " + path("run") +
          " --set motion.model=ackermann --set motion.ackermann_form=seed --set motion.wheelbase=4 "
          "--set calibration.scale_speed.enabled=true");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto summary = nlohmann::json::parse(read_all(path("run/run.json")));
  EXPECT_TRUE(summary.at("truth").contains("ate_rmse_m"));
  EXPECT_TRUE(summary.at("truth").contains("map_rmse_m"));
  EXPECT_LT(std::abs(summary.at("truth").at("calibration_error").at("scale_speed").get<double>()),
            0.05);
}

// X.filter.yaml runs on X.rawlog as it is, whichever sensor filled it.
TEST_F(SlamSimulate, TheFilterItWritesRunsOnItsLog) {
  const std::string folder = LIBSLAM_CONFIG_DIR "/";
  for (const auto& [scenario, source] : {std::pair("sim_stereo.yaml", "fiducials"),
                                         {"sim_stereo_features.yaml", "stereo_points"},
                                         {"sim_webmap.yaml", "range_bearing"}}) {
    ASSERT_EQ(run(kSimulate + " " + folder + scenario + " --force --out " + path("a") +
                  " --set drive.max_duration_s=8")
                  .code,
              0);
    const Outcome outcome = run(kRun + " " + path("a.filter.yaml") + " " + path("a.rawlog") +
                                " --force --set output.report=false --out " + path("run"));
    ASSERT_EQ(outcome.code, 0) << scenario << ": " << outcome.err;
    const auto summary = nlohmann::json::parse(read_all(path("run/run.json")));
    EXPECT_GT(summary.at("result").at("landmarks").get<int>(), 0) << scenario;
    EXPECT_LT(summary.at("truth").at("ate_rmse_m").get<double>(), 1.0) << scenario;
    EXPECT_NE(read_all(path("run/config.yaml")).find(source), std::string::npos) << scenario;
  }
}

TEST_F(SlamSimulate, StockProgramsOpenTheLog) {
  if (run("command -v kf-slam && command -v rawlog-edit").code != 0)
    GTEST_SKIP() << "kf-slam or rawlog-edit is not installed";
  ASSERT_EQ(run(kSimulate + " " + kWebmap + " --out " + path("a") +
                " --set drive.max_duration_s=30 --set log.flavour=merged_pairs")
                .code,
            0);
  const Outcome info = run("rawlog-edit --info -i " + path("a.rawlog"));
  EXPECT_EQ(info.code, 0);
  EXPECT_NE(info.out.find("Actions/SensoryFrame format       : Yes"), std::string::npos);
  write("kf.ini",
        "[MappingApplication]\nkf_implementation = CRangeBearingKFSLAM2D\nrawlog_file = " +
            path("a.rawlog") + "\nlogOutput_dir = " + path("log") +
            "\nSAVE_LOG_FREQUENCY = 1000\nSHOW_3D_LIVE = false\n"
            "[RangeBearingKFSLAM_KalmanFilter]\nmethod = 0\nverbosity_level = INFO\n"
            "[RangeBearingKFSLAM]\nstd_sensor_range = 0.2\nstd_sensor_yaw_deg = 2\n");
  const Outcome slam = run("timeout 60 kf-slam " + path("kf.ini") + " " + path("a.rawlog"));
  EXPECT_EQ(slam.code, 0) << slam.err;
  // 30 s of observations at 5 Hz, one filter step each; the program counts from 0.
  EXPECT_NE(slam.out.find("Step 149 "), std::string::npos);
  EXPECT_EQ(slam.out.find("Step 151 "), std::string::npos);
}

TEST_F(SlamSimulate, CommandLines) {
  EXPECT_EQ(run(kSimulate + " --help").code, 0);
  EXPECT_NE(run(kSimulate + " --help").out.find("Example"), std::string::npos);
  EXPECT_EQ(run(kSimulate + " --version").code, 0);
  EXPECT_NE(run(kSimulate + " --help-config").out.find("range_bearing"), std::string::npos);
  EXPECT_EQ(run(kSimulate + " --no-such-option").code, 2);
  EXPECT_EQ(run(kSimulate + " " + kWebmap + " --seed -1 --out " + path("a")).code, 2);
  const Outcome effective = run(kSimulate + " " + kWebmap + " --seed 12 --print-config");
  EXPECT_EQ(effective.code, 0);
  EXPECT_NE(effective.out.find("seed: 12"), std::string::npos);
}

TEST_F(SlamSimulate, BadScenariosAndFiles) {
  const std::string out = " --out " + path("a");
  expect_one_line(run(kSimulate + " " + path("none.yaml") + out), 3, "none.yaml");
  write("typo.yaml", "drive:\n  sped: 3\n");
  expect_one_line(run(kSimulate + " " + path("typo.yaml") + out), 3, "typo.yaml:2:3");
  expect_one_line(run(kSimulate + " --set truth.track_width=1.1" + out), 3, "truth.track_width");
  expect_one_line(run(kSimulate + " --set world.generator=file --set world.landmarks_file=" +
                      path("l.csv") + " --set world.way_points_file=" + path("l.csv") + out),
                  4, "l.csv: no such file");
  write("l.csv", "id,x,y\n1,2\n");
  expect_one_line(run(kSimulate + " --set world.generator=file --set world.landmarks_file=" +
                      path("l.csv") + " --set world.way_points_file=" + path("l.csv") + out),
                  4, "l.csv:2: ");
  expect_one_line(run(kSimulate + kShort + " --out /no/such/place/a"), 2, "cannot write");
  EXPECT_FALSE(std::filesystem::exists(path("a.rawlog")));
}

TEST_F(SlamSimulate, ReplacesEarlierFilesOnlyWhenForced) {
  const std::string command = kSimulate + kShort + " --out " + path("a");
  ASSERT_EQ(run(command).code, 0);
  expect_one_line(run(command), 2, "--force");
  EXPECT_EQ(run(command + " --force").code, 0);
}

TEST_F(SlamSimulate, WhatWasDrivenBeforeAnErrorIsSaved) {
  const Outcome outcome = run(kSimulate + " " + kWebmap + " --out " + path("a") +
                              " --set drive.steering_limit_deg=0.5");
  expect_one_line(outcome, 2, "out of reach");
  EXPECT_TRUE(std::filesystem::exists(path("a.rawlog")));
  EXPECT_TRUE(std::filesystem::exists(path("a.truth.tum")));
}

TEST_F(SlamSimulate, InterruptSavesWhatWasDriven) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const std::string out = path("a");
    execl(kSimulate.c_str(), kSimulate.c_str(), "--quiet", "--out", out.c_str(), "--set",
          "drive.laps=100000", nullptr);
    _exit(98);
  }
  std::this_thread::sleep_for(std::chrono::seconds(1));
  kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_EQ(run(kRun + " " + path("a.rawlog") + " --out " + path("run") +
                " --set output.report=false --set motion.model=odometry_increment")
                .code,
            0);
}

}  // namespace
}  // namespace libslam
