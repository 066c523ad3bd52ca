#include <cmath>
#include <numbers>

#include <libslam/campaign/campaign_report.hpp>
#include <libslam/campaign/campaign_report_assets.hpp>
#include <libslam/campaign/campaign_report_data.hpp>
#include <libslam/campaign/campaign_report_table.hpp>
#include <libslam/result/report_figures.hpp>
#include <libslam/result/report_html.hpp>

namespace libslam {

namespace {

using Json = nlohmann::ordered_json;

Json constant(const Json& like, const Json& value) {
  return Json::array_t(like.size(), value);
}

Json negated(const Json& values) {
  Json out = Json::array();
  for (const Json& value : values)
    out.push_back(value.is_number() ? Json(-value.get<double>()) : Json());
  return out;
}

std::string still_cell(const Json& cell, const std::string& heading) {
  const Json axis = {{"name", "time"}, {"unit", "s"}};
  std::string html = "<section class=\"plot\"><h2>" + escape_html(heading) + "</h2>";
  if (const Json& nees = cell["nees"]; !nees.is_null())
    html += still_panel_svg(axis, nees["t"],
                            {{"label", "mean NEES, its 95 % band"},
                             {"unit", ""},
                             {"low", nees["mean"]},
                             {"high", nees["mean"]},
                             {"band",
                              {{"low", constant(nees["t"], nees["lower"])},
                               {"high", constant(nees["t"], nees["upper"])}}}});
  if (cell["errors"].is_null()) return html + "</section>\n";
  constexpr const char* kLabels[] = {"x error", "y error", "heading error"};
  constexpr const char* kUnits[] = {"m", "m", "\u00b0"};
  for (std::size_t i = 0; i < 3; ++i) {
    const Json& curve = cell["errors"][i];
    html +=
        still_panel_svg(axis, curve["t"],
                        {{"label", std::string(kLabels[i]) + ", \u00b13\u03c3"},
                         {"unit", kUnits[i]},
                         {"low", curve["error"]},
                         {"high", curve["error"]},
                         {"band", {{"low", negated(curve["bound"])}, {"high", curve["bound"]}}}});
  }
  return html + "</section>\n";
}

/// NEES and errors of the first point; the table says the rest.
std::string still_drawings(const Json& data) {
  std::string html;
  if (data["points"].empty()) return html;
  const Json& point = data["points"][0];
  const auto label = point["label"].get<std::string>();
  for (std::size_t v = 0; v < point["cells"].size(); ++v)
    if (!point["cells"][v].is_null())
      html += still_cell(point["cells"][v], data["variants"][v].get<std::string>() +
                                                (label.empty() ? "" : " at " + label));
  return html;
}

}  // namespace

std::string make_campaign_report(const Json& campaign, const std::string& title,
                                 const std::filesystem::path& library_folder) {
  PageContent page;
  page.title = title;
  page.source = "configuration " + campaign.value("config_sha256", "").substr(0, 12) +
                ", in full in config.yaml beside this page";
  const std::string git = campaign.value("git", "");
  page.program = campaign.value("program", "") + " " + campaign.value("version", "") +
                 (git.empty() ? "" : " (" + git + ")");
  page.cards = campaign_cards_html(campaign);
  page.above = lost_runs_html(campaign);
  page.below = campaign_table_html(campaign);
  page.data = make_campaign_report_data(campaign);
  page.stills = still_drawings(page.data);
  page.style = kCampaignStyle;
  page.script = kCampaignScript;
  return assemble_page(page, library_folder);
}

}  // namespace libslam
