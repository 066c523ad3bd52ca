#pragma once
// The cores of this machine at work on a task board.

#include <atomic>

#include <libslam/campaign/task_board.hpp>

namespace libslam {

/// Works on the tasks of `board` with `threads` threads until none waits, or until `stop` is set:
/// what is under way then is given back. May be called again for tasks that came back since.
/// `threads` >= 1, also beyond the number of cores. Throws what the journal of the board throws.
void work(const CampaignPlan& plan, TaskBoard& board, int threads, const std::atomic<bool>& stop);

}  // namespace libslam
