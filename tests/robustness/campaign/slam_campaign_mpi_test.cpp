// slam-campaign on several processes.

#include <cstdlib>

#include "campaign_program.hpp"

namespace libslam {
namespace {

using namespace test;

class SlamCampaignOnCluster : public CampaignProgram {
 protected:
  void SetUp() override {
    CampaignProgram::SetUp();
    if (run("command -v mpirun").code != 0) GTEST_SKIP() << "mpirun is not installed";
    // Build machines are often containers, where tests run as root.
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    // Programs that a launcher starts inherit its variables; these tests are not such programs.
    if (run("timeout 20 mpirun --oversubscribe -n 2 true").code != 0)
      GTEST_SKIP() << "mpirun cannot start processes here";
  }
  Outcome run_on(int processes, const std::string& arguments) const {
    return run("timeout 60 mpirun --oversubscribe -n " + std::to_string(processes) + " " +
               kCampaign + " " + arguments);
  }
  static std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++found;
    return found;
  }
};

TEST_F(SlamCampaignOnCluster, ResultsDoNotDependOnTheNumberOfProcesses) {
  ASSERT_EQ(run(kCampaign + " " + config_ + " --runs 8" + to("alone")).code, 0);
  for (const int processes : {1, 2, 3}) {
    const std::string name = std::to_string(processes);
    const Outcome outcome = run_on(processes, config_ + " --runs 8" + to(name));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(results(name), results("alone"));
    EXPECT_EQ(count(outcome.out, "results: "), 1U);
    EXPECT_EQ(campaign(name)["timing"]["workers"], processes);
  }
}

TEST_F(SlamCampaignOnCluster, FailingRunsAreRetriedAndRecordedOnce) {
  const std::string swept = write("swept.yaml", read_all(config_) +
                                                    "grid: {scenario.drive.steering_limit_deg: "
                                                    "[45, 0.5]}\n");
  const std::string arguments = swept + " --set scenario.drive.max_duration_s=0";
  ASSERT_EQ(run(kCampaign + " " + arguments + to("alone")).code, 5);
  run_on(2, arguments + to("two"));  // mpirun has its own say about codes other than 0
  EXPECT_EQ(results("two"), results("alone"));
  EXPECT_EQ(campaign("two")["cells"][2]["counts"]["failed"], 3);
}

TEST_F(SlamCampaignOnCluster, AnswersOnceAndEnds) {
  const Outcome help = run_on(2, "--help");
  EXPECT_EQ(help.code, 0);
  EXPECT_EQ(count(help.out, "Example: "), 1U);
  EXPECT_EQ(count(run_on(2, "--version").out, "slam-campaign "), 1U);
  EXPECT_EQ(count(run_on(2, "--help-config").out, "campaign.batches = "), 1U);
  const Outcome effective = run_on(2, config_ + " --print-config");
  EXPECT_EQ(effective.code, 0);
  EXPECT_EQ(count(effective.out, "# campaign\n"), 1U);
}

TEST_F(SlamCampaignOnCluster, ErrorsEndAllProcessesWithTheCode) {
  const auto expect = [&](const std::string& arguments, int code, const std::string& text) {
    const Outcome outcome = run_on(2, arguments);
    EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.err;
    EXPECT_EQ(count(outcome.err, text), 1U) << outcome.err;
  };
  expect(path("none.yaml") + to("a"), 3, "none.yaml: no such file");
  expect("--no-such-option", 2, "--no-such-option");
  write("mine/thesis.tex", "content");
  expect(config_ + to("mine"), 2, "is not empty");
}

TEST_F(SlamCampaignOnCluster, ProcessThatReadsOtherFilesIsNotLetIn) {
  // As on a machine whose copy of the configuration is an old one.
  write("one/mc.yaml", read_all(config_));
  write("two/mc.yaml", read_all(config_) + "grid: {scenario.drive.speed: [1]}\n");
  const std::string start = "timeout 60 mpirun --oversubscribe -n 1 -wdir " + path("one") + " " +
                            kCampaign + " mc.yaml" + to("a") + " : -n 1 -wdir " + path("two") +
                            " " + kCampaign + " mc.yaml" + to("a");
  const Outcome outcome = run(start);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("process 1 on "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("reads other files"), std::string::npos) << outcome.err;
}

TEST_F(SlamCampaignOnCluster, InterruptLeavesADirectoryThatCanBeResumed) {
  const std::string many = " --runs 200 --set scenario.drive.max_duration_s=20";
  const std::vector<std::string> command{
      "mpirun", "--oversubscribe", "-n",     "2",   kCampaign, config_,
      "--out",  path("a"),         "--runs", "200", "--set",   "scenario.drive.max_duration_s=20"};
  EXPECT_NE(run_and_signal(command, "a", SIGTERM), 0);
  const Outcome resumed = run_on(2, config_ + many + to("a") + " --resume --verbose");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(resumed.out.find("\n0 of them done earlier"), std::string::npos) << resumed.out;
  ASSERT_EQ(run(kCampaign + " " + config_ + many + to("whole")).code, 0);
  EXPECT_EQ(results("a"), results("whole"));
}

}  // namespace
}  // namespace libslam
