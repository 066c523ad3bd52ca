#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <vector>

#include <libslam/campaign/campaign_report_data.hpp>
#include <libslam/campaign/campaign_report_table.hpp>
#include <libslam/campaign/figure_lookup.hpp>
#include <libslam/result/report_html.hpp>

namespace libslam {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr const char* kDash = "\u2013";
constexpr std::size_t kListedRuns = 20;

/// A heading and what it means in one sentence.
struct Column {
  const char *name, *meaning;
};

constexpr Column kColumns[] = {
    {"variant", ""},
    {"runs", "done of planned; runs that diverged or failed are left out of all other columns"},
    {"position [m]", "root mean square error over all updates of all runs; in small letters x, y"},
    {"heading [\u00b0]", "the same for the heading"},
    {"NEES", "mean over time and batches; a consistent filter has 3"},
    {"in band",
     "part of the updates with the batch's mean NEES inside its 95 % band: mean over "
     "the batches, in small letters the least and the greatest"},
    {"coverage", "part of the true poses inside the filter's 95 % ellipsoid; should be 0.95"},
    {"position ratio",
     "position error over the reference's on the same logs, in small letters "
     "its 95 % confidence interval; below 1 is better than the reference, and "
     "proven where the interval stays below 1"},
    {"heading ratio", "the same for the heading"},
    {"map ratio", "the same for the landmarks"},
    {"landmarks", "mean number in the final map"},
    {"calibration",
     "mean of the final estimates \u00b1 their spread over the runs; \u03c3 is "
     "what the filter itself claims, and should match the spread where the "
     "parameter is observable"}};

std::string decimals(double value, int digits) {
  if (!std::isfinite(value)) return kDash;
  char text[48];
  std::snprintf(text, sizeof text, std::abs(value) < 1e6 ? "%.*f" : "%.*g", digits, value);
  return text;
}

std::string small(const std::string& text) {
  return " <small>" + text + "</small>";
}

std::string table_cell(const std::string& html, const char* css_class = "") {
  return *css_class == '\0' ? "<td>" + html + "</td>"
                            : std::string("<td class=\"") + css_class + "\">" + html + "</td>";
}

int count_of(const Json& cell, const char* key) {
  const double count = figure_at(cell, {"counts", key});
  return std::isfinite(count) ? static_cast<int>(count) : 0;
}

int planned_runs(const Json& cell) {
  int sum = 0;
  for (const char* key : {"done", "diverged", "failed", "not_run"}) sum += count_of(cell, key);
  return sum;
}

std::string runs_text(const Json& cell) {
  std::string text =
      std::to_string(count_of(cell, "done")) + "/" + std::to_string(planned_runs(cell));
  for (const auto& [key, name] : {std::pair{"diverged", "diverged"}, std::pair{"failed", "failed"},
                                  std::pair{"not_run", "not run"}})
    if (const int count = count_of(cell, key); count > 0)
      text += "<br><span class=\"lost\">" + std::to_string(count) + " " + name + "</span>";
  return text;
}

std::string in_band_text(const Json& cell) {
  std::string text = decimals(figure_at(cell, {"nees", "fraction_in_band"}), 3);
  const Json* batches = value_at(cell, {"nees", "batches"});
  if (batches == nullptr || batches->size() < 2) return text;
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (const Json& batch : *batches) {
    const double fraction = figure_at(batch, {"fraction_in_band"});
    least = std::min(least, fraction);
    greatest = std::max(greatest, fraction);
  }
  return text + small(decimals(least, 2) + " \u2026 " + decimals(greatest, 2));
}

std::string ratio_text(const Json& cell, const char* figure) {
  const double ratio = figure_at(cell, {"comparison", figure, "ratio"});
  if (!std::isfinite(ratio)) {
    const bool is_reference = value_at(cell, {"pooled"}) && !value_at(cell, {"comparison"});
    return is_reference ? "<span class=\"quiet\">reference</span>" : kDash;
  }
  std::string interval = "[";
  interval.append(decimals(figure_at(cell, {"comparison", figure, "lower"}), 3)).append(", ");
  interval.append(decimals(figure_at(cell, {"comparison", figure, "upper"}), 3)).append("]");
  return decimals(ratio, 3) + small(interval);
}

std::string calibration_text(const Json& cell) {
  const Json* calibration = value_at(cell, {"calibration"});
  if (calibration == nullptr) return "";
  std::string text;
  for (const auto& [name, figures] : calibration->items()) {
    const bool observable = !(figure_at(figures, {"observable", "mean"}) < 0.5);
    text += escape_html(name) + " " + decimals(figure_at(figures, {"mean", "mean"}), 4) +
            " \u00b1 " + decimals(figure_at(figures, {"mean", "sd"}), 4) +
            small("\u03c3 " + decimals(figure_at(figures, {"sigma", "mean"}), 4) +
                  (observable ? "" : ", alone not observable"));
  }
  return text;
}

std::string row_html(const Json& cell) {
  const std::string position = decimals(figure_at(cell, {"pooled", "rmse_position_m"}), 3) +
                               small(decimals(figure_at(cell, {"pooled", "rmse_x_m"}), 2) + ", " +
                                     decimals(figure_at(cell, {"pooled", "rmse_y_m"}), 2));
  const double heading = kDegrees * figure_at(cell, {"pooled", "rmse_heading_rad"});
  return "<tr><th scope=\"row\">" + escape_html(cell.at("variant").get<std::string>()) + "</th>" +
         table_cell(runs_text(cell)) + table_cell(value_at(cell, {"pooled"}) ? position : kDash) +
         table_cell(decimals(heading, 3)) +
         table_cell(decimals(figure_at(cell, {"nees", "time_mean"}), 2)) +
         table_cell(in_band_text(cell)) +
         table_cell(decimals(figure_at(cell, {"truth", "nees_coverage_95", "mean"}), 3)) +
         table_cell(ratio_text(cell, "rmse_position")) +
         table_cell(ratio_text(cell, "rmse_heading")) + table_cell(ratio_text(cell, "rmse_map")) +
         table_cell(decimals(figure_at(cell, {"health", "landmarks", "mean"}), 1)) +
         table_cell(calibration_text(cell), "calibration") + "</tr>\n";
}

std::string reference_of(const Json& cells) {
  for (const Json& cell : cells)
    if (const Json* name = value_at(cell, {"comparison", "reference"})) return *name;
  return "";
}

}  // namespace

std::string campaign_cards_html(const Json& campaign) {
  const Json& cells = campaign.at("cells");
  Card size("Campaign");
  const int batches = campaign.value("batches", 1), runs = campaign.value("runs", 0);
  size.row("logs per point", std::to_string(batches * runs) + " (" + std::to_string(batches) +
                                 (batches == 1 ? " batch" : " batches") + " of " +
                                 std::to_string(runs) + ")");
  const Json data_seed = campaign.value("seed", Json());
  if (data_seed.is_number_integer())
    size.row("seeds", std::to_string(data_seed.get<long long>()) + " \u2026 " +
                          std::to_string(data_seed.get<long long>() + batches * runs - 1));
  if (const std::string reference = reference_of(cells); !reference.empty())
    size.row("reference of the ratios", reference);
  const double wall = figure_at(campaign, {"timing", "wall_s"});
  if (std::isfinite(wall))
    size.row("wall time", format_figure(wall, "s") + " with " +
                              format_figure(figure_at(campaign, {"timing", "workers"})) +
                              " workers");
  Card outcome("Outcome, filters \u00d7 logs");
  for (const auto& [key, name] :
       {std::pair{"done", "done"}, std::pair{"diverged", "diverged"},
        std::pair{"failed", "failed twice"}, std::pair{"not_run", "not run"}}) {
    int sum = 0;
    for (const Json& cell : cells) sum += count_of(cell, key);
    outcome.row(name, std::to_string(sum));
  }
  return size.html() + outcome.html();
}

std::string lost_runs_html(const Json& campaign) {
  std::vector<std::string> lost;
  std::size_t count = 0;
  for (const Json& cell : campaign.at("cells"))
    for (const Json& run : cell.at("runs")) {
      const std::string status = run.at("status");
      if (status == "done" || status == "not run" || ++count > kListedRuns) continue;
      const std::string label = point_label(cell.at("point"));
      lost.push_back(cell.at("variant").get<std::string>() + (label.empty() ? "" : " at " + label) +
                     ", seed " + run.at("seed").dump() + ": " + status);
    }
  if (count > kListedRuns)
    lost.push_back(std::to_string(count - kListedRuns) + " more; campaign.json names them");
  return warnings_html("Runs without a result", lost);
}

std::string campaign_table_html(const Json& campaign) {
  std::string html =
      "<section class=\"plot figures\"><h2>Figures</h2><div class=\"wide\"><table>\n<thead><tr>";
  for (const Column& column : kColumns)
    html +=
        std::string("<th scope=\"col\" title=\"") + column.meaning + "\">" + column.name + "</th>";
  html += "</tr></thead>\n";
  const Json* point = nullptr;
  int number = 0;
  for (const Json& cell : campaign.at("cells")) {
    if (point == nullptr || *point != cell.at("point")) {
      html += point == nullptr ? "<tbody>\n" : "</tbody>\n<tbody>\n";
      point = &cell.at("point");
      if (const std::string label = point_label(*point); !label.empty())
        html += "<tr class=\"point\"><th colspan=\"" + std::to_string(std::size(kColumns)) + "\">" +
                std::to_string(++number) + ": " + escape_html(label) + "</th></tr>\n";
    }
    html += row_html(cell);
  }
  html +=
      std::string(point == nullptr ? "" : "</tbody>\n") + "</table></div>\n<dl class=\"meanings\">";
  for (const Column& column : kColumns)
    if (*column.meaning != '\0')
      html += std::string("<div><dt>") + column.name + "</dt><dd>" + column.meaning + "</dd></div>";
  return html + "</dl></section>\n";
}

}  // namespace libslam
