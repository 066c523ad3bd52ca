#pragma once
// One task of a campaign: simulate a log and let every filter of its point see it, in memory.

#include <atomic>

#include <libslam/campaign/campaign_plan.hpp>
#include <libslam/campaign/run_outcome.hpp>

namespace libslam {

/// The steps are those that slam-simulate would write and slam-run read. A filter that throws or
/// diverges is reported in its own outcome; the others go on. Throws what the simulation throws.
/// `stop`, if set on the way, ends the run early with std::runtime_error.
RunOutcome run_task(const CampaignPlan& plan, const CampaignTask& task,
                    const std::atomic<bool>* stop = nullptr);

}  // namespace libslam
