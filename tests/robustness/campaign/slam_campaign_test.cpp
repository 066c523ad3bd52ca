// What slam-campaign promises to people and scripts.

#include "campaign_program.hpp"

namespace libslam {
namespace {

using namespace test;

class SlamCampaign : public CampaignProgram {};

TEST_F(SlamCampaign, WritesTheFilesOfACampaignAndReproducesThem) {
  const Outcome outcome = run(kCampaign + " " + config_ + to("a"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");  // no bar where there is no terminal
  for (const char* file : {"campaign.json", "config.yaml", "log.txt", "report.html"})
    EXPECT_TRUE(std::filesystem::exists(path("a/") + file)) << file;
  EXPECT_EQ(read_all(path("a/log.txt")), outcome.out);
  EXPECT_NE(read_all(path("a/report.html")).find("<title>a"), std::string::npos);
  EXPECT_EQ(campaign("a")["cells"].size(), 2U);
  EXPECT_EQ(campaign("a")["cells"][1]["counts"]["done"], 3);
  ASSERT_EQ(run(kCampaign + " " + config_ + to("b") + " --threads 3 --no-report").code, 0);
  EXPECT_EQ(results("a"), results("b"));
  EXPECT_FALSE(std::filesystem::exists(path("b/report.html")));
}

TEST_F(SlamCampaign, CommandLines) {
  const Outcome help = run(kCampaign + " --help");
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.out.find("Example: slam-campaign config/mc_webmap.yaml"), std::string::npos);
  EXPECT_NE(run(kCampaign + " --version").out.find("slam-campaign "), std::string::npos);
  EXPECT_NE(run(kCampaign + " --help-config").out.find("campaign.batches"), std::string::npos);
  EXPECT_EQ(run(kCampaign).code, 2);
  for (const char* wrong : {" --no-such-option", " --runs 0", " --seed -1", " --threads 0",
                            " --resume", " --quiet --verbose", " --help-config pdf"})
    EXPECT_EQ(run(kCampaign + " " + config_ + wrong).code, 2) << wrong;
  EXPECT_EQ(run(kCampaign + " " + config_ + to("a") + " --resume --force").code, 2);
  EXPECT_FALSE(std::filesystem::exists(path("a")));
}

TEST_F(SlamCampaign, SettingsChangeThePlan) {
  const std::string command = kCampaign + " " + config_ +
                              " --runs 2 --batches 2 --seed 9 --set scenario.drive.speed=2 "
                              "--set filter.measurement.sigma_range=0.9";
  const Outcome effective = run(command + " --print-config");
  EXPECT_EQ(effective.code, 0);
  EXPECT_NE(effective.out.find("sigma_range: 0.9"), std::string::npos);
  ASSERT_EQ(run(command + to("a")).code, 0);
  const auto runs = campaign("a")["cells"][0]["runs"];
  ASSERT_EQ(runs.size(), 4U);
  EXPECT_EQ(runs[3]["seed"], 12);
  EXPECT_EQ(read_all(path("a/config.yaml")), effective.out);
}

TEST_F(SlamCampaign, MistakesHaveOneLineAndTheirExitCode) {
  expect_one_line(run(kCampaign + " " + path("none.yaml") + to("a")), 3, "none.yaml");
  write("typo.yaml", "campaign:\n  rums: 3\n");
  expect_one_line(run(kCampaign + " " + path("typo.yaml") + to("a")), 3, "typo.yaml:2:3");
  write("far.yaml", "scenario: none.yaml\n");
  expect_one_line(run(kCampaign + " " + path("far.yaml") + to("a")), 3, "none.yaml: no such file");
  expect_one_line(run(kCampaign + " " + config_ + " --set truth.x=1" + to("a")), 3, "--set");
  expect_one_line(
      run(kCampaign + " " + config_ +
          " --set scenario.world.generator=file --set scenario.world.landmarks_file=" +
          path("l.csv") + " --set scenario.world.way_points_file=" + path("l.csv") + to("a")),
      4, "l.csv: no such file");
  EXPECT_FALSE(std::filesystem::exists(path("a")));
}

TEST_F(SlamCampaign, DirectoryThatCannotBeUsed) {
  const std::string command = kCampaign + " " + config_;
  write("file", "content");
  expect_one_line(run(command + to("file")), 2, "file: cannot be made a directory");
  expect_one_line(run(command + to("file/a")), 2, "file/a: cannot be made a directory");
  write("mine/thesis.tex", "content");
  expect_one_line(run(command + to("mine")), 2, "mine: is not empty and holds no campaign");
  expect_one_line(run(command + to("mine") + " --resume"), 2, "holds no campaign");
  EXPECT_FALSE(std::filesystem::exists(path("mine/config.yaml")));
}

TEST_F(SlamCampaign, DirectoryIsReplacedOnlyWhenForced) {
  const std::string command = kCampaign + " " + config_ + to("a");
  ASSERT_EQ(run(command + " --resume").code, 0);  // nothing there: begins
  const std::string first = results("a"), config = read_all(path("a/config.yaml"));
  expect_one_line(run(command), 2, "--resume goes on with it, --force starts over");
  expect_one_line(run(command + " --resume --runs 4"), 2, "belongs to another campaign");
  EXPECT_EQ(read_all(path("a/config.yaml")), config);  // refused before anything was touched
  EXPECT_EQ(results("a"), first);
  ASSERT_EQ(run(command + " --resume").code, 0);
  EXPECT_EQ(results("a"), first);
  ASSERT_EQ(run(command + " --force --runs 4").code, 0);
  EXPECT_EQ(campaign("a")["cells"][0]["counts"]["done"], 4);
}

TEST_F(SlamCampaign, QuietAndVerbose) {
  const Outcome quiet = run(kCampaign + " " + config_ + to("a") + " --quiet");
  EXPECT_EQ(quiet.code, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
  const Outcome verbose = run(kCampaign + " " + config_ + to("a") + " --resume --verbose");
  EXPECT_NE(verbose.out.find("3 of them done earlier"), std::string::npos) << verbose.out;
}

TEST_F(SlamCampaign, FailedRunsAreCountedNamedAndTriedAgain) {
  const std::string command = kCampaign + " " + config_ + to("a") +
                              " --set scenario.drive.max_duration_s=0"
                              " --set scenario.drive.steering_limit_deg=0.5";
  for (const char* session : {"", " --resume"}) {
    const Outcome outcome = run(command + session);
    EXPECT_EQ(outcome.code, 5);
    EXPECT_NE(outcome.out.find("out of reach"), std::string::npos) << outcome.out;
    EXPECT_EQ(campaign("a")["cells"][0]["counts"]["failed"], 3);
    EXPECT_EQ(campaign("a")["cells"][0]["runs"][0]["retried"], true);
  }
}

TEST_F(SlamCampaign, InterruptLeavesADirectoryThatCanBeResumed) {
  const std::vector<std::string> command{
      kCampaign, config_, "--out", path("a"),
      "--runs",  "100",   "--set", "scenario.drive.max_duration_s=20"};
  EXPECT_EQ(run_and_signal(command, "a", SIGINT), 7);
  const auto counts = campaign("a")["cells"][0]["counts"];
  EXPECT_GT(counts["done"], 0);
  EXPECT_GT(counts["not_run"], 0);
  EXPECT_EQ(counts["failed"], 0);
  EXPECT_NE(read_all(path("a/log.txt")).find("interrupted: "), std::string::npos);
  const std::string again = " --runs 100 --set scenario.drive.max_duration_s=20";
  ASSERT_EQ(run(kCampaign + " " + config_ + again + to("a") + " --resume").code, 0);
  ASSERT_EQ(run(kCampaign + " " + config_ + again + to("whole")).code, 0);
  EXPECT_EQ(results("a"), results("whole"));
}

TEST_F(SlamCampaign, KillLosesAtMostWhatWasUnderWay) {
  const std::vector<std::string> command{
      kCampaign, config_, "--out", path("a"),
      "--runs",  "100",   "--set", "scenario.drive.max_duration_s=20"};
  EXPECT_EQ(run_and_signal(command, "a", SIGKILL), -SIGKILL);
  const std::string again = " --runs 100 --set scenario.drive.max_duration_s=20";
  const Outcome resumed = run(kCampaign + " " + config_ + again + to("a") + " --resume --verbose");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(resumed.out.find("\n0 of them done earlier"), std::string::npos) << resumed.out;
  ASSERT_EQ(run(kCampaign + " " + config_ + again + to("whole")).code, 0);
  EXPECT_EQ(results("a"), results("whole"));
}

TEST_F(SlamCampaign, ShippedCampaignsAreValid) {
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(LIBSLAM_CONFIG_DIR)) {
    if (!entry.path().filename().string().starts_with("mc_")) continue;
    ++found;
    const Outcome outcome = run(kCampaign + " " + entry.path().string() + " --print-config");
    EXPECT_EQ(outcome.code, 0) << entry.path() << ": " << outcome.err;
  }
  EXPECT_GT(found, 0);
}

}  // namespace
}  // namespace libslam
