#pragma once
// campaign.json: the figures of all runs, the same for any number of workers but for `timing`.

#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include <libslam/campaign/campaign_plan.hpp>
#include <libslam/campaign/run_outcome.hpp>

namespace libslam {

/// What a reader has to know besides the outcomes.
struct CampaignEnvironment {
  std::string config_sha256;
  double wall_s = 0.0;  ///< of the sessions that this one has seen
  int workers = 1;
};

/// `outcomes` by number of the task, nothing where it was not done.
///
/// Per cell (point x variant): `truth`, `health`, `calibration` and `timing` as {mean, median, p95,
/// sd} over the runs that were done; `pooled` root mean square errors over all their updates;
/// `nees` (mean over the first batch by update, band, and a list of batches); `comparison` with the
/// reference variant on the same logs; `example`, errors and sigmas of the first run; `runs`.
nlohmann::ordered_json campaign_to_json(const CampaignPlan& plan,
                                        const std::vector<std::optional<RunOutcome>>& outcomes,
                                        const CampaignEnvironment& environment);

}  // namespace libslam
