#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <libslam/campaign/simulated_run.hpp>
#include <libslam/campaign/workers.hpp>

namespace libslam {

namespace {

void work_alone(const CampaignPlan& plan, TaskBoard& board, const std::atomic<bool>& stop) {
  while (!stop.load()) {
    const auto task = board.next();
    if (!task) return;
    std::vector<std::uint8_t> outcome;
    try {
      outcome = to_bytes(run_task(plan, *task, &stop));
    } catch (const std::exception& error) {
      if (stop.load())
        board.give_back(*task);
      else
        board.fail(*task, error.what());
      continue;
    }
    board.succeed(*task, outcome);
  }
}

}  // namespace

void work(const CampaignPlan& plan, TaskBoard& board, int threads, const std::atomic<bool>& stop) {
  // TBB would not use more threads than there are cores.
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::task_group group;
    for (int i = 0; i < threads; ++i) group.run([&] { work_alone(plan, board, stop); });
    group.wait();
  });
}

}  // namespace libslam
