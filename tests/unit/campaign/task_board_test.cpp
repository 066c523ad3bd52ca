#include <set>
#include <utility>

#include <gtest/gtest.h>

#include <libslam/campaign/task_board.hpp>

#include "campaign_fixture.hpp"

namespace libslam {
namespace {

using namespace test;

class Board : public testing::Test {
 protected:
  Journal journal() const { return Journal(directory_.path() / "runs.journal", identify(plan_)); }
  std::vector<std::uint8_t> outcome(const std::string& status) const {
    return to_bytes(outcome_of(plan_.points[0].variants.size(), status));
  }

  TemporaryDirectory directory_;
  CampaignPlan plan_ = small_plan(3);
};

TEST_F(Board, HandsOutEveryTaskOnce) {
  Journal file = journal();
  std::vector<std::pair<std::size_t, std::size_t>> calls;
  TaskBoard board(plan_, file,
                  [&](std::size_t done, std::size_t total) { calls.emplace_back(done, total); });
  std::set<std::size_t> seen;
  while (const auto task = board.next()) {
    EXPECT_TRUE(seen.insert(task->index).second);
    EXPECT_FALSE(board.finished());
    board.succeed(*task, outcome("done"));
  }
  EXPECT_EQ(seen.size(), 3U);
  EXPECT_TRUE(board.finished());
  EXPECT_EQ(calls, (decltype(calls){{1, 3}, {2, 3}, {3, 3}}));
  for (const auto& done : board.outcomes()) {
    ASSERT_TRUE(done);
    EXPECT_FALSE(done->retried);
  }
}

TEST_F(Board, FailureIsRetriedOnceBehindTheOthersThenRecorded) {
  Journal file = journal();
  TaskBoard board(plan_, file);
  std::vector<std::size_t> order;
  while (const auto task = board.next()) {
    order.push_back(task->index);
    if (task->index == 0)
      board.fail(*task, "out of luck");
    else
      board.succeed(*task, outcome("done"));
  }
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 0}));
  EXPECT_TRUE(board.finished());
  EXPECT_EQ(board.done(), 3U);  // counted once
  ASSERT_TRUE(board.outcomes()[0]);
  EXPECT_TRUE(board.outcomes()[0]->retried);
  ASSERT_EQ(board.outcomes()[0]->variants.size(), 2U);
  EXPECT_EQ(board.outcomes()[0]->variants[1].status, "failed: out of luck");
}

TEST_F(Board, FilterThatFailsOnceIsRetriedAndTheSecondOutcomeStands) {
  Journal file = journal();
  TaskBoard board(plan_, file);
  int attempts = 0;
  while (const auto task = board.next()) {
    const bool fails = task->index == 1 && attempts++ == 0;
    board.succeed(*task, outcome(fails ? "failed: once" : "done"));
  }
  EXPECT_EQ(attempts, 2);
  EXPECT_TRUE(board.outcomes()[1]->retried);
  EXPECT_TRUE(board.outcomes()[1]->variants[0].done());
  EXPECT_FALSE(board.outcomes()[0]->retried);
  const auto summary = campaign_to_json(plan_, board.outcomes(), {});
  EXPECT_EQ(summary["cells"][0]["counts"]["done"], 3);
  EXPECT_EQ(summary["cells"][0]["runs"][1]["retried"], true);
  EXPECT_FALSE(summary["cells"][0]["runs"][0].contains("retried"));
}

TEST_F(Board, DivergedIsAResultAndNotRetried) {
  Journal file = journal();
  TaskBoard board(plan_, file);
  int handed_out = 0;
  for (; const auto task = board.next(); ++handed_out) board.succeed(*task, outcome("diverged"));
  EXPECT_EQ(handed_out, 3);
}

TEST_F(Board, WhatIsGivenBackComesNextAndIsNoFailure) {
  Journal file = journal();
  TaskBoard board(plan_, file);
  const auto task = board.next();
  board.give_back(*task);
  EXPECT_EQ(board.next()->index, task->index);
  board.succeed(*task, outcome("done"));
  EXPECT_FALSE(board.outcomes()[0]->retried);
}

TEST_F(Board, LaterSessionSkipsWhatIsDoneAndRetriesFailures) {
  {
    Journal file = journal();
    TaskBoard board(plan_, file);
    const auto first = board.next(), second = board.next();
    board.succeed(*first, outcome("done"));
    board.succeed(*second, outcome("failed: disk"));  // interrupted before its second attempt
    const auto third = board.next();
    board.succeed(*third, outcome("failed: memory"));
    board.succeed(*board.next(), outcome("failed: disk"));
    EXPECT_FALSE(board.finished());
  }
  Journal file = journal();
  TaskBoard board(plan_, file);
  EXPECT_EQ(board.done(), 1U);
  ASSERT_TRUE(board.outcomes()[0]);
  for (const std::size_t expected : {1U, 2U}) {
    const auto task = board.next();
    ASSERT_TRUE(task);
    EXPECT_EQ(task->index, expected);
    board.succeed(*task, outcome("done"));
  }
  EXPECT_TRUE(board.finished());
  EXPECT_TRUE(board.outcomes()[1]->retried);
  EXPECT_FALSE(board.outcomes()[2]->retried);  // its failure had not been recorded
}

TEST_F(Board, BytesThatAreNoOutcomeThrowAndLoseNothing) {
  Journal file = journal();
  TaskBoard board(plan_, file);
  const auto task = board.next();
  EXPECT_THROW(board.succeed(*task, {1, 2, 3}), nlohmann::json::exception);
  board.fail(*task, "garbled");
  std::set<std::size_t> rest;
  while (const auto next = board.next()) rest.insert(next->index);
  EXPECT_EQ(rest.size(), 3U);
}

}  // namespace
}  // namespace libslam
