#pragma once
// report.html of a campaign: one self-contained page that compares its filters.

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include <libslam/result/report_page.hpp>

namespace libslam {

/// The page as HTML, see assemble_page. `campaign`: what campaign_to_json returns, complete or not;
/// a part that is missing there is missing here, and the page says so.
std::string make_campaign_report(
    const nlohmann::ordered_json& campaign, const std::string& title,
    const std::filesystem::path& library_folder = plotting_library_folder());

}  // namespace libslam
