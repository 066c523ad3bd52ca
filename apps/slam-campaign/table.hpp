#pragma once
// The figures of a campaign as a table for a terminal.

#include <string>

#include <nlohmann/json.hpp>

namespace libslam {

/// One row per cell of campaign.json.
std::string campaign_table(const nlohmann::ordered_json& campaign);

}  // namespace libslam
