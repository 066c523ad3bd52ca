#pragma once
// The keys of a campaign and of its scenario, for people.

#include <string>

namespace libslam {

/// As plain text, named as `--set` and a grid name them.
std::string campaign_help_text();
/// As a page with an introduction: the content of config/CAMPAIGNS.md.
std::string campaign_help_markdown();

}  // namespace libslam
