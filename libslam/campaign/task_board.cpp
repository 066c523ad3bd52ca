#include <algorithm>
#include <utility>

#include <libslam/campaign/task_board.hpp>

namespace libslam {

namespace {

bool any_failed(const RunOutcome& outcome) {
  return std::ranges::any_of(outcome.variants, &VariantOutcome::failed);
}

}  // namespace

TaskBoard::TaskBoard(const CampaignPlan& plan, Journal& journal,
                     std::function<void(std::size_t, std::size_t)> on_done)
    : plan_(plan),
      journal_(journal),
      on_done_(std::move(on_done)),
      attempts_(plan.tasks()),
      outcomes_(plan.tasks()) {
  read_journal();
  for (std::size_t i = 0; i < outcomes_.size(); ++i)
    if (!outcomes_[i]) waiting_.push_back(i);
}

void TaskBoard::read_journal() {
  for (const Journal::Record& record : journal_.take_records()) {
    if (record.number >= outcomes_.size()) continue;
    RunOutcome outcome = outcome_from_bytes(record.bytes);
    if (any_failed(outcome)) {
      attempts_[record.number].failed_earlier = true;
      continue;
    }
    done_ += !outcomes_[record.number];
    outcomes_[record.number] = std::move(outcome);
  }
}

std::optional<CampaignTask> TaskBoard::next() {
  const std::lock_guard lock(mutex_);
  if (waiting_.empty()) return std::nullopt;
  const std::size_t index = waiting_.front();
  waiting_.pop_front();
  return task_of(plan_, index);
}

void TaskBoard::succeed(const CampaignTask& task, const std::vector<std::uint8_t>& bytes) {
  RunOutcome outcome = outcome_from_bytes(bytes);
  const std::lock_guard lock(mutex_);
  if (any_failed(outcome) && put_back_once(task.index)) return;
  record(task.index, std::move(outcome));
}

void TaskBoard::fail(const CampaignTask& task, const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (put_back_once(task.index)) return;
  RunOutcome outcome;
  outcome.variants.resize(plan_.points[task.point].variants.size());
  for (VariantOutcome& variant : outcome.variants) variant.status = "failed: " + why;
  record(task.index, std::move(outcome));
}

void TaskBoard::give_back(const CampaignTask& task) {
  const std::lock_guard lock(mutex_);
  waiting_.push_front(task.index);
}

/// False for a task that has failed before.
bool TaskBoard::put_back_once(std::size_t index) {
  if (attempts_[index].failed_now) return false;
  attempts_[index].failed_now = true;
  waiting_.push_back(index);
  return true;
}

void TaskBoard::record(std::size_t index, RunOutcome outcome) {
  outcome.retried = attempts_[index].failed_now || attempts_[index].failed_earlier;
  journal_.append({index, to_bytes(outcome)});
  outcomes_[index] = std::move(outcome);
  ++done_;
  if (on_done_) on_done_(done_, outcomes_.size());
}

bool TaskBoard::finished() const {
  const std::lock_guard lock(mutex_);
  return done_ == outcomes_.size();
}

std::size_t TaskBoard::done() const {
  const std::lock_guard lock(mutex_);
  return done_;
}

}  // namespace libslam
