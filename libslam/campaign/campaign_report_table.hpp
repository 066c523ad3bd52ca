#pragma once
// The still parts of a campaign's report: cards, the list of lost runs, and the table.

#include <string>

#include <nlohmann/json.hpp>

namespace libslam {

/// Cards with the size and the outcome of the campaign, as HTML.
std::string campaign_cards_html(const nlohmann::ordered_json& campaign);

/// The runs that have no result, with their reasons; empty where all have one.
std::string lost_runs_html(const nlohmann::ordered_json& campaign);

/// A row per cell, grouped by grid point, and what its columns mean.
std::string campaign_table_html(const nlohmann::ordered_json& campaign);

}  // namespace libslam
