#include "cluster.hpp"

#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <future>
#include <mpi.h>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <libslam/campaign/simulated_run.hpp>
#include <libslam/campaign/workers.hpp>

namespace libslam {

namespace {

using Bytes = std::vector<std::uint8_t>;
using namespace std::chrono_literals;

// From the others to rank 0: the number of a task, then its outcome or what went wrong.
enum Tag { kReady = 1, kDone, kFailed, kLeaving, kTask };

constexpr int kIdentityLength = 64;
constexpr std::uint64_t kNoMoreTasks = ~std::uint64_t{0};
constexpr auto kPause = 1ms;  // between looks for messages: a task takes much longer

void send(int rank, Tag tag, std::uint64_t number, const Bytes& bytes = {}) {
  Bytes message(sizeof(number));
  std::memcpy(message.data(), &number, sizeof(number));
  message.insert(message.end(), bytes.begin(), bytes.end());
  MPI_Send(message.data(), static_cast<int>(message.size()), MPI_BYTE, rank, tag, MPI_COMM_WORLD);
}

struct Message {
  int source = 0, tag = 0;
  std::uint64_t number = 0;
  Bytes bytes;
};

/// False if none has arrived.
bool receive(Message& message) {
  int arrived = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &arrived, &status);
  if (arrived == 0) return false;
  int size = 0;
  MPI_Get_count(&status, MPI_BYTE, &size);
  Bytes raw(static_cast<std::size_t>(size));
  MPI_Recv(raw.data(), size, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  message.source = status.MPI_SOURCE;
  message.tag = status.MPI_TAG;
  std::memcpy(&message.number, raw.data(), sizeof(message.number));
  message.bytes.assign(raw.begin() + sizeof(message.number), raw.end());
  return true;
}

void take(const CampaignPlan& plan, TaskBoard& board, const Message& message) {
  if (message.tag == kReady) return;
  const CampaignTask task = task_of(plan, message.number);
  if (message.tag == kDone)
    board.succeed(task, message.bytes);
  else if (message.tag == kFailed)
    board.fail(task, std::string(message.bytes.begin(), message.bytes.end()));
  else
    board.give_back(task);
}

/// The outcome of one task, sent to rank 0. False where this process has to end.
bool run_and_send(const CampaignPlan& plan, std::uint64_t number, const std::atomic<bool>& stop) {
  try {
    send(0, kDone, number, to_bytes(run_task(plan, task_of(plan, number), &stop)));
  } catch (const std::exception& error) {
    const bool leaving = stop.load();
    const std::string why = error.what();
    send(0, leaving ? kLeaving : kFailed, number, Bytes(why.begin(), why.end()));
    return !leaving;
  }
  return true;
}

}  // namespace

bool Cluster::launched() {
  for (const char* variable :
       {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE", "MPI_LOCALNRANKS"})
    if (std::getenv(variable) != nullptr) return true;
  return false;
}

Cluster::Cluster(int& argc, char**& argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

Cluster::~Cluster() {
  MPI_Finalize();
}

void Cluster::abort(int exit_code) {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::exit(exit_code);
}

std::string Cluster::name() const {
  std::array<char, MPI_MAX_PROCESSOR_NAME> host{};
  int length = 0;
  MPI_Get_processor_name(host.data(), &length);
  return "process " + std::to_string(rank_) + " on " + host.data();
}

std::string Cluster::share(const std::string& identity) const {
  std::string shared = identity;
  shared.resize(kIdentityLength);
  MPI_Bcast(shared.data(), kIdentityLength, MPI_CHAR, 0, MPI_COMM_WORLD);
  return shared;
}

void Cluster::lead(const CampaignPlan& plan, TaskBoard& board,
                   const std::atomic<bool>& stop) const {
  // Its destructor waits for the thread, whatever else is thrown here.
  std::future<void> own_work = std::async(std::launch::async, [&] {
    while (!board.finished() && !stop.load()) {
      work(plan, board, 1, stop);
      std::this_thread::sleep_for(kPause);  // another rank may give a task back
    }
  });
  distribute(plan, board, stop, own_work);
  own_work.get();
}

void Cluster::distribute(const CampaignPlan& plan, TaskBoard& board, const std::atomic<bool>& stop,
                         const std::future<void>& own_work) const {
  std::set<int> idle;
  for (int working = size_ - 1; working > 0; std::this_thread::sleep_for(kPause)) {
    for (Message message; receive(message);) {
      take(plan, board, message);
      if (message.tag == kLeaving)
        --working;
      else
        idle.insert(message.source);
    }
    // In this order: this process ends its own work when all is over, or by an error.
    const bool own_work_ended = own_work.wait_for(0s) == std::future_status::ready;
    const bool over = stop.load() || board.finished();
    if (own_work_ended && !over) return;
    while (!idle.empty()) {
      const auto task = over ? std::nullopt : board.next();
      if (!task && !over) break;  // others still work and may fail: keep waiting
      send(*idle.begin(), kTask, task ? task->index : kNoMoreTasks);
      if (!task) --working;
      idle.erase(idle.begin());
    }
  }
}

void Cluster::assist(const CampaignPlan& plan, const std::atomic<bool>& stop) const {
  send(0, kReady, 0);
  for (;;) {
    Message message;
    while (!receive(message)) std::this_thread::sleep_for(kPause);
    if (message.number == kNoMoreTasks || !run_and_send(plan, message.number, stop)) return;
  }
}

}  // namespace libslam
