#pragma once
// Which tasks of a campaign wait, are under way, and are done; asked from many threads.

#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <libslam/campaign/campaign_plan.hpp>
#include <libslam/campaign/journal.hpp>
#include <libslam/campaign/run_outcome.hpp>

namespace libslam {

/// A task that fails (its simulation or one of its filters throws, its process reports an error) is
/// handed out once more, behind the others; the second failure is recorded as its outcome. What a
/// journal already holds is not handed out, failures excepted: those get another two attempts.
class TaskBoard {
 public:
  /// `on_done` is called after each task, never twice at a time. Both references must outlive the
  /// board. Throws what the journal throws.
  TaskBoard(const CampaignPlan& plan, Journal& journal,
            std::function<void(std::size_t done, std::size_t total)> on_done = {});

  /// Nothing when no task waits now; those under way may still come back (`finished`).
  std::optional<CampaignTask> next();
  /// Throws nlohmann::json::exception where the bytes are no outcome.
  void succeed(const CampaignTask& task, const std::vector<std::uint8_t>& outcome);
  void fail(const CampaignTask& task, const std::string& why);
  /// The task was not finished for no fault of its own; a later session will.
  void give_back(const CampaignTask& task);

  bool finished() const;
  std::size_t done() const;
  /// By number of the task; nothing where it was not done. Not while tasks are under way.
  const std::vector<std::optional<RunOutcome>>& outcomes() const { return outcomes_; }

 private:
  struct Attempts {
    bool failed_now = false;      ///< in this session
    bool failed_earlier = false;  ///< as the journal says
  };
  void read_journal();
  bool put_back_once(std::size_t index);
  void record(std::size_t index, RunOutcome outcome);

  const CampaignPlan& plan_;
  Journal& journal_;
  std::function<void(std::size_t, std::size_t)> on_done_;
  mutable std::mutex mutex_;
  std::deque<std::size_t> waiting_;
  std::vector<Attempts> attempts_;
  std::vector<std::optional<RunOutcome>> outcomes_;
  std::size_t done_ = 0;
};

}  // namespace libslam
