#pragma once
// The files of assets/, embedded by CMake.

#include <string_view>

namespace libslam {

extern const std::string_view kCampaignStyle;   ///< assets/campaign.css
extern const std::string_view kCampaignScript;  ///< assets/chart.js and campaign.js

}  // namespace libslam
