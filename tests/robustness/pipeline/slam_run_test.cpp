// slam-run and slam-evaluate as a user meets them: exit codes, one-line messages, nothing lost.

#include <chrono>
#include <signal.h>
#include <support/program_run.hpp>
#include <thread>
#include <unistd.h>

#include <nlohmann/json.hpp>

namespace libslam {
namespace {

using namespace libslam::test;

const std::string kRun = LIBSLAM_SLAM_RUN, kEvaluate = LIBSLAM_SLAM_EVALUATE;
const std::string kConfig = LIBSLAM_CONFIG_DIR "/range_bearing.yaml";
const std::string kIni = "/usr/share/mrpt/config_files/kf-slam/EKF-SLAM_test_2d.ini";

class SlamRun : public ProgramTest {
 protected:
  Outcome slam_run(const std::string& arguments) const {
    return run(kRun + " " + arguments + " --out " + path("run"));
  }
  nlohmann::json summary() const { return nlohmann::json::parse(read_all(path("run/run.json"))); }

  /// One line on stderr that holds `text`.
  void expect_refused(const Outcome& outcome, int code, const std::string& text) const {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  }
};

TEST_F(SlamRun, AGoodLogGivesTheWholeRunDirectory) {
  const Outcome outcome = slam_run(kConfig + " " + kGoodLog);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* name : {"run.json", "config.yaml", "trajectory.tum", "trajectory.csv", "map.csv",
                           "map.simplemap", "scene.3Dscene", "report.html", "log.txt"})
    EXPECT_GT(read_all(path(std::string("run/") + name)).size(), 0u) << name;
  EXPECT_EQ(summary()["result"]["landmarks"], 70);
  EXPECT_LT(summary()["truth"]["ate_rmse_m"], 0.005);
  // The effective configuration reproduces the run bit for bit, with any number of threads.
  const std::string trajectory = read_all(path("run/trajectory.csv"));
  EXPECT_EQ(run(kRun + " " + path("run/config.yaml") + " " + kGoodLog + " --threads 2 --out " +
                path("again"))
                .code,
            0);
  EXPECT_EQ(read_all(path("again/trajectory.csv")), trajectory);
  EXPECT_EQ(read_all(path("again/map.csv")), read_all(path("run/map.csv")));
  const Outcome table = run(kEvaluate + " " + path("run") + " " + path("again"));
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_NE(table.out.find("again"), std::string::npos);
}

TEST_F(SlamRun, SaysWhereAdaptedNoiseIsFarFromTheConfiguredOne) {
  const std::string adaptive = kConfig + " " + kGoodLog + " --set measurement.noise=configured" +
                               " --set policies.noise_adaptation.method=residual" +
                               " --set measurement.sigma_bearing_deg=";
  const auto warned = [&] { return summary()["input"]["warnings"].dump(); };
  EXPECT_EQ(slam_run(adaptive + "0.2").code, 0);
  EXPECT_EQ(warned().find("bearing"), std::string::npos) << warned();
  const Outcome outcome = slam_run(adaptive + "1 --force");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string expected = "the sigma of bearing was adapted to ";
  EXPECT_NE(warned().find(expected), std::string::npos) << warned();
  EXPECT_NE(warned().find(" rad where 0.0175 rad was configured"), std::string::npos) << warned();
  EXPECT_NE(outcome.err.find(expected), std::string::npos) << outcome.err;
  EXPECT_NE(read_all(path("run/report.html")).find(expected), std::string::npos);
}

TEST_F(SlamRun, TheStockIniFileIsAcceptedUnchanged) {
  EXPECT_EQ(slam_run(kIni + " " + kGoodLog).code, 0);
  EXPECT_EQ(summary()["result"]["landmarks"], 70);
}

TEST_F(SlamRun, CommandLineAndConfigurationErrors) {
  EXPECT_EQ(slam_run("--no-such-option").code, 2);
  EXPECT_EQ(slam_run("").code, 2);
  EXPECT_EQ(run(kRun + " --help").code, 0);
  EXPECT_NE(run(kRun + " --help").out.find("Example"), std::string::npos);
  EXPECT_EQ(run(kRun + " --version").code, 0);
  EXPECT_NE(run(kRun + " --help-config").out.find("gate_probability"), std::string::npos);
  write("bad.yaml", "association:\n  gate_probabilty: 0.9\n");
  expect_refused(slam_run(path("bad.yaml") + " " + kGoodLog), 3, "gate_probability");
  expect_refused(slam_run(path("bad.yaml") + " " + kGoodLog), 3, "bad.yaml:2:");
  expect_refused(slam_run(path("none.yaml") + " " + kGoodLog), 3, "none.yaml");
  expect_refused(slam_run(kConfig + " " + kGoodLog + " --set filter.error_frame=sideways"), 3,
                 "right_invariant");
  expect_refused(slam_run(kConfig + " " + kGoodLog + " --set calibration.scale_left.enabled=true"),
                 3, "scale_left");
  EXPECT_FALSE(std::filesystem::exists(path("run")));
}

TEST_F(SlamRun, RejectedInputLeavesNothingBehind) {
  expect_refused(slam_run(kConfig + " " + path("none.rawlog")), 4, "none.rawlog");
  write("empty.rawlog", "");
  expect_refused(slam_run(kConfig + " " + path("empty.rawlog")), 4, "empty.rawlog");
  write("noise.rawlog", std::string(1000, '\x5a'));
  expect_refused(slam_run(kConfig + " " + path("noise.rawlog")), 4, "noise.rawlog");
  EXPECT_FALSE(std::filesystem::exists(path("run")));
}

TEST_F(SlamRun, ATruncatedLogKeepsWhatCameBefore) {
  const std::string whole = read_all(kGoodLog);
  write("half.rawlog", whole.substr(0, whole.size() / 2));
  const Outcome outcome = slam_run(kConfig + " " + path("half.rawlog"));
  EXPECT_EQ(outcome.code, 5) << outcome.err;
  EXPECT_EQ(summary()["exit_code"], 5);
  EXPECT_GT(summary()["timing"]["steps"], 50);
  EXPECT_GT(summary()["result"]["landmarks"], 20);
  const Outcome strict = run(kRun + " " + kConfig + " " + path("half.rawlog") +
                             " --input-policy strict --out " + path("strict"));
  EXPECT_EQ(strict.code, 4) << strict.err;
  EXPECT_GT(read_all(path("strict/trajectory.csv")).size(), 1000u);
}

TEST_F(SlamRun, OutputThatCannotBeWrittenOrIsInUse) {
  expect_refused(run(kRun + " " + kConfig + " " + kGoodLog + " --out /proc/none/run"), 2,
                 "/proc/none/run");
  write("run/precious.txt", "keep me");
  expect_refused(slam_run(kConfig + " " + kGoodLog), 2, "--force");
  EXPECT_EQ(read_all(path("run/precious.txt")), "keep me");
  EXPECT_EQ(slam_run(kConfig + " " + kGoodLog + " --force").code, 0);
  EXPECT_EQ(read_all(path("run/precious.txt")), "keep me");
}

TEST_F(SlamRun, InterruptionsAtAnyMomentLeaveAValidRunDirectory) {
  const std::string log = odometry_log(1000, [](int, auto&) {});
  for (const int delay_ms : {150, 370, 810}) {
    std::filesystem::remove_all(path("run"));
    const pid_t child = fork();
    ASSERT_NE(child, -1);
    if (child == 0) {
      (void)!freopen(path("out").c_str(), "w", stdout);
      (void)!freopen(path("err").c_str(), "w", stderr);
      execl(kRun.c_str(), kRun.c_str(), kConfig.c_str(), log.c_str(), "--speed", "50", "--out",
            path("run").c_str(), nullptr);
      _exit(127);
    }
    for (int i = 0; i < 4000 && !std::filesystem::exists(path("run/trajectory.csv")); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
    kill(child, SIGINT);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status)) << delay_ms;
    EXPECT_EQ(WEXITSTATUS(status), 7) << read_all(path("err"));
    EXPECT_EQ(summary()["exit_code"], 7);
    const std::string trajectory = read_all(path("run/trajectory.csv"));
    EXPECT_EQ(trajectory.back(), '\n');
    EXPECT_EQ(std::count(trajectory.begin(), trajectory.end(), '\n') - 1,
              summary()["timing"]["steps"].get<long>());
    EXPECT_GT(read_all(path("run/report.html")).size(), 1000u);
    EXPECT_GT(read_all(path("run/config.yaml")).size(), 1000u);
  }
}

TEST_F(SlamRun, IgnoredIdentitiesCannotCollideWithRunningNumbers) {
  const std::string gates =
      " --set association.gate_probability=0.5 --set association.new_landmark_probability=0.5"
      " --set association.confirm_after=1";
  const std::string unknown = LIBSLAM_CONFIG_DIR "/range_bearing_unknown_ids.yaml ";
  EXPECT_EQ(slam_run(unknown + kGoodLog + gates).code, 0);
  EXPECT_GT(summary()["result"]["landmarks"], 70);
}

TEST_F(SlamRun, TheProcessAndItsSummaryAgreeOnTheExitCode) {
  // The demo log carries no velocities.
  EXPECT_EQ(slam_run(kConfig + " " + kGoodLog + " --set input.odometry=velocities").code, 3);
  EXPECT_EQ(summary()["exit_code"], 3);
}

TEST_F(SlamRun, AnInterruptionDoesNotWaitForTheNextEntry) {
  const std::string log = odometry_log(
      3, [](int i, auto& o) { o.timestamp = mrpt::Clock::fromDouble(1000.0 + 500.0 * i); });
  const auto begin = std::chrono::steady_clock::now();
  const Outcome outcome = run("timeout --signal=INT 1 " + kRun + " " + kConfig + " " + log +
                              " --speed 1 --out " + path("run"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
  EXPECT_EQ(summary()["exit_code"], 7) << outcome.err;
}

TEST_F(SlamRun, AnUpdatePeriodLongerThanTheLogIsSaid) {
  const Outcome outcome =
      slam_run(kConfig + " " + kGoodLog + " --set policies.update_period_s=0.5");
  EXPECT_NE(outcome.err.find("update_period_s"), std::string::npos) << outcome.err;
}

TEST_F(SlamRun, OdometryThatIsNotFiniteIsLeftOutOrRefused) {
  const std::string log = odometry_log(50, [](int i, auto& o) {
    if (i == 20) o.odometry.x(std::numeric_limits<double>::quiet_NaN());
  });
  EXPECT_EQ(slam_run(kConfig + " " + log).code, 5);
  EXPECT_NEAR(summary()["result"]["pose"][0].get<double>(), 4.9, 1e-9);
  EXPECT_EQ(
      run(kRun + " " + kConfig + " " + log + " --input-policy strict --out " + path("strict")).code,
      4);
}

}  // namespace
}  // namespace libslam
