#pragma once
// Many processes at one campaign, on one machine or on many: rank 0 hands out tasks and works too.

#include <atomic>
#include <future>
#include <string>

#include <libslam/campaign/task_board.hpp>

namespace libslam {

/// The MPI session of a process that an MPI launcher (mpirun, srun) has started. Every process
/// works on one task at a time; start one per core. Rank 0 alone writes files.
class Cluster {
 public:
  /// True where the environment is that of an MPI launcher.
  static bool launched();

  Cluster(int& argc, char**& argv);
  ~Cluster();
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  /// "process 3 on node7".
  std::string name() const;

  /// What rank 0 works on (64 characters), told to all; each process must call it once.
  std::string share(const std::string& identity) const;

  /// Rank 0: returns once nothing is left to do, or `stop` is set and all ranks have let go.
  /// Throws what the journal of the board throws.
  void lead(const CampaignPlan& plan, TaskBoard& board, const std::atomic<bool>& stop) const;
  /// The others: tasks until rank 0 says that there are none, or `stop` is set here.
  void assist(const CampaignPlan& plan, const std::atomic<bool>& stop) const;
  /// One process cannot go on: all end, with `exit_code`.
  [[noreturn]] static void abort(int exit_code);

 private:
  void distribute(const CampaignPlan& plan, TaskBoard& board, const std::atomic<bool>& stop,
                  const std::future<void>& own_work) const;

  int rank_ = 0, size_ = 1;
};

}  // namespace libslam
