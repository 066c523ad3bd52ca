#include <atomic>
#include <optional>

#include <gtest/gtest.h>

#include <libslam/campaign/workers.hpp>

#include "campaign_fixture.hpp"

namespace libslam {
namespace {

using namespace test;

class Workers : public testing::Test {
 protected:
  /// campaign.json without `timing` after a session in its own journal; stops after so many logs.
  std::string run(const std::string& name, int threads,
                  std::optional<std::size_t> stop_after = std::nullopt) {
    Journal journal(directory_.path() / name, identify(plan_));
    std::atomic<bool> stop{false};
    TaskBoard board(plan_, journal, [&](std::size_t done, std::size_t) {
      if (stop_after && done >= *stop_after) stop = true;
    });
    work(plan_, board, threads, stop);
    finished_ = board.finished();
    done_ = board.done();
    return results(plan_, board);
  }

  TemporaryDirectory directory_;
  CampaignPlan plan_ = small_plan(6, 2);
  bool finished_ = false;
  std::size_t done_ = 0;
};

TEST_F(Workers, ResultsDoNotDependOnTheNumberOfThreads) {
  const std::string expected = run("one", 1);
  EXPECT_TRUE(finished_);
  for (const int threads : {2, 4}) EXPECT_EQ(run(std::to_string(threads), threads), expected);
}

TEST_F(Workers, InterruptGivesWorkBackAndTheNextSessionCompletesIt) {
  const std::string expected = run("whole", 2);
  run("parts", 2, 3);
  EXPECT_FALSE(finished_);
  EXPECT_GE(done_, 3U);
  EXPECT_LE(done_, 4U);  // the other thread may just have finished its log
  run("parts", 2, 7);
  EXPECT_FALSE(finished_);
  EXPECT_EQ(run("parts", 4), expected);
  EXPECT_TRUE(finished_);
  EXPECT_EQ(run("parts", 1), expected);  // nothing left to do
}

TEST_F(Workers, WorkGivenBackIsNoFailedAttempt) {
  const std::string expected = run("whole", 2);
  Journal journal(directory_.path() / "parts", identify(plan_));
  std::atomic<bool> stop{false};
  TaskBoard board(plan_, journal, [&](std::size_t, std::size_t) { stop = true; });
  int sessions = 0;
  for (; !board.finished(); ++sessions) {
    stop = false;
    work(plan_, board, 3, stop);
  }
  EXPECT_GT(sessions, 1);
  EXPECT_EQ(results(plan_, board), expected);  // `retried` would be in there
}

TEST_F(Workers, FailingRunsAreRecordedAndTheOthersAreDone) {
  plan_ = load_text(
      kSmallScenario + kTwoVariants + "grid: {scenario.drive.steering_limit_deg: [45, 0.5]}\n",
      {"campaign.runs=2", "scenario.drive.max_duration_s=0"});
  const auto summary = nlohmann::json::parse(run("failing", 2));
  EXPECT_TRUE(finished_);
  EXPECT_EQ(summary["cells"][0]["counts"]["done"], 2);
  EXPECT_EQ(summary["cells"][2]["counts"]["failed"], 2);
  const auto& row = summary["cells"][2]["runs"][0];
  EXPECT_EQ(row["retried"], true);
  EXPECT_NE(row["status"].get<std::string>().find("out of reach"), std::string::npos);
}

TEST_F(Workers, JournalThatCannotBeWrittenEndsTheWork) {
  // As on a full disk: a record that cannot be appended must not be taken for done.
  Journal journal(directory_.path() / "x", identify(plan_));
  TaskBoard board(plan_, journal,
                  [](std::size_t, std::size_t) { throw std::runtime_error("no space left"); });
  const std::atomic<bool> stop{false};
  EXPECT_THROW(work(plan_, board, 2, stop), std::runtime_error);
  EXPECT_FALSE(board.finished());
}

}  // namespace
}  // namespace libslam
