#pragma once
// A shipped campaign, run in memory on all cores.

#include <atomic>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <tests/support/temporary_directory.hpp>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include <libslam/campaign/campaign_json.hpp>
#include <libslam/campaign/campaign_plan.hpp>
#include <libslam/campaign/journal.hpp>
#include <libslam/campaign/task_board.hpp>
#include <libslam/campaign/workers.hpp>

namespace libslam::test {

/// campaign.json of a finished campaign.
class CampaignRun {
 public:
  /// `config`: a file of config/; `settings` as of slam-campaign --set.
  CampaignRun(const std::string& config, std::vector<std::string> settings) {
    settings.insert(settings.begin(), "campaign.batches=6");  // a later setting wins
    const CampaignPlan plan =
        load_campaign(std::filesystem::path(LIBSLAM_CONFIG_DIR) / config, settings);
    const TemporaryDirectory scratch;
    Journal journal(scratch.path() / "journal", std::string(64, '0'));
    TaskBoard board(plan, journal);
    const std::atomic<bool> stop{false};
    work(plan, board, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())), stop);
    json_ = campaign_to_json(plan, board.outcomes(), {});
  }

  /// The cell of a variant at a point of the grid, by number.
  const nlohmann::ordered_json& cell(const std::string& variant, std::size_t point = 0) const {
    for (const auto& cell : json_["cells"])
      if (cell["variant"] == variant && point-- == 0) return cell;
    throw std::out_of_range("no cell " + variant);
  }
  double pooled(const std::string& variant, const char* figure, std::size_t point = 0) const {
    return cell(variant, point)["pooled"][figure];
  }
  /// `figure` of a variant per that of another.
  double ratio(const std::string& variant, const std::string& to, const char* figure,
               std::size_t point = 0) const {
    return pooled(variant, figure, point) / pooled(to, figure, point);
  }
  int done(const std::string& variant, std::size_t point = 0) const {
    return cell(variant, point)["counts"]["done"];
  }

 private:
  nlohmann::ordered_json json_;
};

constexpr int kRuns = 300;
constexpr const char* kPosition = "rmse_position_m";
constexpr const char* kHeading = "rmse_heading_rad";

}  // namespace libslam::test
