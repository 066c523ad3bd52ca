#pragma once
// A campaign as a configuration: which runs of which scenarios with which filters.
//
//   campaign: {runs: 50, batches: 6, seed: 1, reference: standard}
//   scenario: sim_webmap.yaml                  a file beside this one, or a mapping
//   filter: {measurement: {sigma_range: 0.3}}  a file or a mapping; over what the scenario knows
//   variants:                                  name -> changes of the filter; all see the same logs
//     standard: {filter: {error_frame: standard}}
//     mrpt: {engine: mrpt}
//   grid:                                      every combination is a point; keys joined by commas
//     scenario.truth.scale_left, scenario.truth.scale_right: [1.0, 1.05]      change together
//
// A variant has the last word: what it sets, the grid does not change. The seed of the scenario
// does not count.
//
// The filter knows the nominal vehicle of the scenario (section `motion`, with its noise), its
// odometry field and the nominal noise of its range-bearing sensor unless `filter` says otherwise.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <libslam/config/parameters.hpp>
#include <libslam/simulation/scenario.hpp>

namespace libslam {

/// Section `campaign`.
struct CampaignParameters {
  int runs = 50;
  int batches = 1;
  int seed = 1;
  std::string reference = "";
  double diverged_beyond = 0.0;

  void describe(auto& v) {
    v.value("runs", runs, {"1", "Runs of each batch.", 1, 1'000'000});
    v.value("batches", batches,
            {"1", "Batches: the consistency band is that of the runs of one batch.", 1, 10'000});
    v.value("seed", seed,
            {"1", "Seed of the first run; run r of batch b has seed + b * runs + r.", 0});
    v.value("reference", reference,
            {"", "Variant that the others are compared with, run by run; empty: the first."});
    v.value("diverged_beyond", diverged_beyond,
            {"m", "A run counts as diverged once its position error exceeds this; 0: never.", 0});
  }
};

/// Whose filter: ours, or MRPT's CRangeBearingKFSLAM2D with its default or with Davison's method.
enum class Engine { kLibslam, kMrpt, kMrptDavison };

/// A filter of a campaign.
struct Variant {
  std::string name;
  Engine engine = Engine::kLibslam;
  Parameters parameters;
};

/// One combination of the grid.
struct GridPoint {
  std::vector<std::pair<std::string, std::string>> settings;  ///< key -> value; empty: no grid
  Scenario scenario;
  std::vector<Variant> variants;  ///< the same names in all points
};

struct CampaignPlan {
  CampaignParameters campaign;
  std::vector<GridPoint> points;  ///< at least one
  std::size_t reference = 0;      ///< among the variants

  std::size_t runs_per_point() const {
    return static_cast<std::size_t>(campaign.runs) * static_cast<std::size_t>(campaign.batches);
  }
  std::size_t tasks() const { return points.size() * runs_per_point(); }
};

/// One simulated log, seen by every variant of its point.
struct CampaignTask {
  std::size_t index = 0;  ///< 0 ... CampaignPlan::tasks()
  std::size_t point = 0;
  int batch = 0, run = 0;
  std::uint64_t seed = 0;
};

/// The task with a number; tasks of a point follow each other, batch by batch.
CampaignTask task_of(const CampaignPlan& plan, std::size_t index);

/// Loads a plan. `settings`: "campaign.KEY=V", "scenario.KEY=V" or "filter.KEY=V", applied before
/// the grid and the variants. Throws ConfigError like load_yaml, also for a combination that no
/// filter can run (naming variant and point) and for a plan beyond a million logs, and InputError
/// for a file of the world that is missing or broken.
CampaignPlan load_campaign(const std::filesystem::path& file,
                           const std::vector<std::string>& settings = {});

/// The complete effective plan: a YAML document for the campaign, and for each point one of its
/// scenario and one of each filter.
std::string to_yaml(const CampaignPlan& plan);

/// SHA-256 of all that the results depend on: the effective plan, the contents of the files of its
/// worlds (not their names), and the version of this library. Throws std::runtime_error where a
/// file cannot be read.
std::string identify(const CampaignPlan& plan);

}  // namespace libslam
