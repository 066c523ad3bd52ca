#pragma once
// Campaigns small enough for tests.

#include <string>
#include <support/temporary_directory.hpp>
#include <vector>

#include <nlohmann/json.hpp>

#include <libslam/campaign/campaign_json.hpp>
#include <libslam/campaign/campaign_plan.hpp>
#include <libslam/campaign/run_outcome.hpp>
#include <libslam/campaign/task_board.hpp>

namespace libslam::test {

/// A scenario of four seconds, as a part of a campaign file.
inline const std::string kSmallScenario = R"(
scenario:
  world: {landmarks: 40, size_x: 60, size_y: 60}
  drive: {max_duration_s: 4}
  motion: {model: ackermann, ackermann_form: seed, wheelbase: 4}
  truth: {scale_left: 1.05, scale_right: 1.05}
)";
inline const std::string kTwoVariants = R"(
variants:
  standard: {filter: {error_frame: standard}}
  invariant:
)";

inline CampaignPlan load_text(const std::string& text,
                              const std::vector<std::string>& settings = {}) {
  const TemporaryDirectory directory;
  return load_campaign(directory.write("mc.yaml", text), settings);
}

inline CampaignPlan small_plan(int runs, int batches = 1) {
  return load_text(kSmallScenario + kTwoVariants, {"campaign.runs=" + std::to_string(runs),
                                                   "campaign.batches=" + std::to_string(batches)});
}

/// The campaign without any `timing`.
inline nlohmann::ordered_json without_timing(const nlohmann::ordered_json& value) {
  if (!value.is_structured()) return value;
  nlohmann::ordered_json out = value;
  if (value.is_object()) out.erase("timing");
  for (auto& part : out) part = without_timing(part);
  return out;
}

inline std::string results(const CampaignPlan& plan, const TaskBoard& board) {
  return without_timing(campaign_to_json(plan, board.outcomes(), {})).dump();
}

/// An outcome of so many variants, all with one status.
inline RunOutcome outcome_of(std::size_t variants, const std::string& status) {
  RunOutcome outcome;
  outcome.variants.resize(variants);
  for (VariantOutcome& variant : outcome.variants) variant.status = status;
  return outcome;
}

}  // namespace libslam::test
