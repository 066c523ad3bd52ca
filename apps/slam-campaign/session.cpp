#include "session.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <thread>

#include <libslam/campaign/campaign_json.hpp>
#include <libslam/campaign/campaign_plan.hpp>
#include <libslam/campaign/campaign_report.hpp>
#include <libslam/campaign/journal.hpp>
#include <libslam/campaign/task_board.hpp>
#include <libslam/campaign/workers.hpp>
#include <libslam/config/digest.hpp>
#include <libslam/result/atomic_file.hpp>

#include "progress.hpp"
#include "table.hpp"

namespace libslam {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr const char* kJournal = "runs.journal";

std::vector<std::string> all_settings(const Arguments& arguments) {
  std::vector<std::string> settings = arguments.settings;
  const auto add = [&](const std::string& key, const std::optional<int>& value) {
    if (value) settings.push_back(key + std::to_string(*value));
  };
  add("campaign.runs=", arguments.runs);
  add("campaign.batches=", arguments.batches);
  add("campaign.seed=", arguments.seed);
  return settings;
}

fs::path choose_directory(const Arguments& arguments) {
  if (!arguments.out.empty()) return arguments.out;
  const std::string stem = "campaign-" + fs::path(arguments.config).stem().string() + "-";
  for (int i = 1;; ++i)
    if (const fs::path candidate = stem + std::to_string(i); !fs::exists(candidate))
      return candidate;
}

void prepare_directory(const fs::path& directory, const Arguments& arguments) {
  std::error_code failure;
  fs::create_directories(directory, failure);
  if (failure || !fs::is_directory(directory))
    throw std::runtime_error(directory.string() + ": cannot be made a directory" +
                             (failure ? ": " + failure.message() : ""));
  const bool campaign = fs::exists(directory / kJournal);
  if (fs::is_empty(directory) || (campaign && (arguments.resume || arguments.force))) return;
  throw std::runtime_error(directory.string() + ": is not empty" +
                           (campaign ? "; --resume goes on with it, --force starts over"
                                     : " and holds no campaign; choose another directory"));
}

int count_workers(const Arguments& arguments, const Cluster* cluster) {
  if (cluster != nullptr) return cluster->size();
  if (arguments.threads > 0) return arguments.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// A process that reads another configuration or is another program would compute something else.
void assist(const Arguments& arguments, const Cluster& cluster, const std::atomic<bool>& stop) {
  std::optional<CampaignPlan> plan;
  std::string identity, difference = "reads other files or is another version than process 0";
  try {
    plan = load_campaign(arguments.config, all_settings(arguments));
    identity = identify(*plan);
  } catch (const std::exception& error) {
    difference = error.what();
  }
  // Process 0 meets a common error as well; it ends all before it shares anything.
  if (cluster.share(identity) != identity)
    throw std::runtime_error(cluster.name() + ": " + difference);
  cluster.assist(*plan, stop);
}

/// The name of the directory, also of one given as "." or with a slash at its end.
std::string report_title(const fs::path& directory) {
  return fs::weakly_canonical(directory).filename().string();
}

struct Failures {
  int count = 0;
  std::string first;
};

Failures find_failures(const Json& summary) {
  Failures failures;
  for (const Json& cell : summary["cells"])
    for (const Json& run : cell["runs"]) {
      const auto status = run["status"].get<std::string>();
      if (!status.starts_with("failed")) continue;
      if (failures.count++ == 0)
        failures.first =
            cell["variant"].get<std::string>() + ", seed " + run["seed"].dump() + ", " + status;
    }
  return failures;
}

struct Session {
  const CampaignPlan& plan;
  const Arguments& arguments;
  fs::path directory;
  std::string config_sha256;
  int workers;
};

/// Seconds that earlier sessions have worked, as far as they came to write it down.
double earlier_seconds(const fs::path& directory) {
  std::ifstream in(directory / "campaign.json");
  const Json earlier = Json::parse(in, nullptr, false);
  const auto wall = Json::json_pointer("/timing/wall_s");
  return earlier.is_object() && earlier.contains(wall) && earlier[wall].is_number()
             ? earlier[wall].get<double>()
             : 0.0;
}

/// Files and figures at the end, complete or not.
ExitCode conclude(const Session& session, const TaskBoard& board, double wall_s) {
  const Json summary = campaign_to_json(session.plan, board.outcomes(),
                                        {session.config_sha256, wall_s, session.workers});
  replace_file(session.directory / "campaign.json",
               summary.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  if (session.arguments.report)
    replace_file(session.directory / "report.html",
                 make_campaign_report(summary, report_title(session.directory)));
  std::string trouble;
  const Failures failures = find_failures(summary);
  if (failures.count > 0)
    trouble += "warning: " + std::to_string(failures.count) +
               " runs failed twice; all stand in campaign.json under runs, the first is: " +
               failures.first + "\n";
  const bool complete = board.finished();
  if (!complete)
    trouble += "interrupted: " + std::to_string(board.done()) + " of " +
               std::to_string(session.plan.tasks()) +
               " logs done; the same call with --resume goes on\n";
  const std::string log =
      campaign_table(summary) + trouble + "results: " + session.directory.string() + "\n";
  replace_file(session.directory / "log.txt", log);
  if (session.arguments.quiet)
    std::cerr << trouble;
  else
    std::cout << log;
  return !complete ? kInterrupted : failures.count > 0 ? kIncomplete : kDone;
}

void announce(const Session& session, const TaskBoard& board) {
  std::cout << session.plan.tasks() << " logs: " << session.plan.points.size() << " points x "
            << session.plan.campaign.batches << " batches x " << session.plan.campaign.runs
            << " runs, each seen by " << session.plan.points.front().variants.size() << " filters\n"
            << board.done() << " of them done earlier; at work: " << session.workers
            << (session.workers == 1 ? " core\n" : " cores\n") << std::flush;
}

}  // namespace

ExitCode run_campaign(const Arguments& arguments, const Cluster* cluster,
                      const std::atomic<bool>& stop) {
  const bool leads = cluster == nullptr || cluster->rank() == 0;
  if (arguments.print_config) {
    if (leads) std::cout << to_yaml(load_campaign(arguments.config, all_settings(arguments)));
    return kDone;
  }
  if (!leads) {
    assist(arguments, *cluster, stop);
    return kDone;
  }
  const CampaignPlan plan = load_campaign(arguments.config, all_settings(arguments));
  const std::string effective = to_yaml(plan), identity = identify(plan);
  const Session session{plan, arguments, choose_directory(arguments), sha256_of_text(effective),
                        count_workers(arguments, cluster)};
  prepare_directory(session.directory, arguments);
  Journal journal(session.directory / kJournal, identity,
                  arguments.force ? Journal::Opening::kReplace : Journal::Opening::kContinue);
  const double earlier = arguments.resume ? earlier_seconds(session.directory) : 0.0;
  // Results of an earlier campaign must not stand beside the configuration of this one.
  for (const char* result : {"campaign.json", "report.html", "log.txt"})
    fs::remove(session.directory / result);
  replace_file(session.directory / "config.yaml", effective);
  if (cluster != nullptr) cluster->share(identity);
  const Clock::time_point start = Clock::now();
  std::optional<Progress> progress(arguments.quiet);
  TaskBoard board(plan, journal,
                  [&](std::size_t done, std::size_t total) { progress->show(done, total); });
  if (arguments.verbose) announce(session, board);
  if (cluster != nullptr)
    cluster->lead(plan, board, stop);
  else
    work(plan, board, session.workers, stop);
  progress.reset();
  return conclude(session, board,
                  earlier + std::chrono::duration<double>(Clock::now() - start).count());
}

}  // namespace libslam
