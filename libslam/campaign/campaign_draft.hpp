#pragma once
// What a campaign file and the command line say, before it is applied to anything.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <libslam/campaign/campaign_plan.hpp>
#include <libslam/config/yaml_document.hpp>

namespace libslam {

/// Several keys that take the same value.
struct GridAxis {
  std::vector<std::string> keys;    ///< "scenario.KEY" or "filter.KEY"
  std::vector<std::string> values;  ///< at least one
};

struct VariantDraft {
  std::string name;
  Engine engine = Engine::kLibslam;
  YamlNode changes;  ///< a mapping
};

struct CampaignDraft {
  std::filesystem::path file;
  YamlNode scenario, filter;           ///< a file name, a mapping, or null
  std::vector<VariantDraft> variants;  ///< at least one
  std::vector<GridAxis> grid;
  std::vector<std::string> scenario_settings, filter_settings;  ///< "KEY=V" of the command line
};

/// Reads `file`, then `settings` ("campaign.KEY=V", "scenario.KEY=V", "filter.KEY=V"); what
/// concerns the campaign itself is applied to `campaign`. Throws ConfigError with the place.
CampaignDraft read_campaign_draft(const std::filesystem::path& file,
                                  const std::vector<std::string>& settings,
                                  CampaignParameters& campaign);

/// "scenario." or "filter." at the front of a key, else nothing.
std::string_view target_of(std::string_view key);

}  // namespace libslam
