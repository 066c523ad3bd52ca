#include <cstdio>
#include <numbers>
#include <optional>

#include <libslam/result/report_figures.hpp>

namespace libslam {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr const char* kDash = "\u2013";

std::string format(double value, const char* unit = "") {
  char text[48];
  std::snprintf(text, sizeof text, "%.4g", value);
  return *unit != '\0' ? std::string(text) + "\u202f" + unit : text;
}

/// One card: a heading and rows of name, value.
class Card {
 public:
  explicit Card(const char* title)
      : html_(std::string("<section class=\"card\"><h3>") + title + "</h3><dl>") {}
  Card& row(std::string_view name, const std::string& value) {
    html_ += "<div><dt>" + escape_html(name) + "</dt><dd>" + escape_html(value) + "</dd></div>";
    ++rows_;
    return *this;
  }
  Card& row(const char* name, const std::optional<double>& value, const char* unit = "",
            double factor = 1.0) {
    return value ? row(name, format(*value * factor, unit)) : *this;
  }
  std::string html() const { return rows_ > 0 ? html_ + "</dl></section>\n" : ""; }

 private:
  std::string html_;
  int rows_ = 0;
};

std::string run_card(const RunSummary& s) {
  Card card("Run");
  card.row("status", s.status + " (exit code " + std::to_string(s.exit_code) + ")");
  if (s.result.pose)
    card.row("final pose", format(s.result.pose->x(), "m") + ", " +
                               format(s.result.pose->y(), "m") + ", " +
                               format(s.result.pose->z() * kDegrees, "\u00b0"));
  card.row("landmarks", std::to_string(s.result.landmarks));
  card.row("log", std::to_string(s.input.entries) + " entries, " + format(s.input.duration_s, "s"));
  if (s.input.skipped + s.input.repaired > 0)
    card.row("skipped / repaired",
             std::to_string(s.input.skipped) + " / " + std::to_string(s.input.repaired));
  if (s.seed) card.row("seed", std::to_string(*s.seed));
  return card.html();
}

std::string path_card(const TruthComparison& truth) {
  Card card("Path against truth");
  if (!truth.path) return "";
  const PathErrors& path = *truth.path;
  if (path.raw)
    card.row("ATE raw", path.raw->rmse_m, "m")
        .row("mean / max", format(path.raw->mean_m, "m") + " / " + format(path.raw->max_m, "m"))
        .row("x / y", format(path.raw->rmse_x_m, "m") + " / " + format(path.raw->rmse_y_m, "m"));
  if (path.aligned)
    card.row("ATE aligned", path.aligned->rmse_m, "m")
        .row("mean / max",
             format(path.aligned->mean_m, "m") + " / " + format(path.aligned->max_m, "m"));
  if (path.heading)
    card.row("heading", path.heading->rmse_rad, "\u00b0", kDegrees)
        .row("heading max", path.heading->max_rad, "\u00b0", kDegrees);
  if (truth.relative)
    card.row("drift over " + format(truth.relative->distance_m, "m"),
             format(truth.relative->trans_percent, "%") + ", " +
                 format(truth.relative->rot_deg_per_m, "\u00b0/m"));
  return card.row("matched poses", std::to_string(path.poses)).html();
}

std::string map_card(const TruthComparison& truth) {
  if (!truth.map) return "";
  const MapErrors& map = *truth.map;
  return Card("Map against truth")
      .row("map raw", map.rmse_m, "m")
      .row("map aligned", map.rmse_aligned_m, "m")
      .row("matched", std::to_string(map.matched))
      .row("missed / duplicate",
           std::to_string(map.missed) + " / " + std::to_string(map.duplicates))
      .html();
}

std::string consistency_card(const RunSummary& s) {
  Card card("Consistency");
  if (s.truth && s.truth->nees) {
    const NeesSummary& nees = *s.truth->nees;
    card.row("NEES mean (ideal 3)", nees.mean).row("NEES median (ideal 2.37)", nees.median);
    card.row("NEES in 95 %", nees.in_95, "%", 100.0);
    std::string quarters;
    for (const auto& mean : nees.quarter_mean)
      quarters +=
          (quarters.empty() ? "" : " \u00b7 ") + (mean ? format(*mean) : std::string(kDash));
    card.row("NEES by quarter", quarters);
  }
  return card.row("NIS / dof (ideal 1)", s.health.nis_mean)
      .row("NIS in 95 %", s.health.nis_in_95, "%", 100.0)
      .row("gated", s.health.gated_fraction, "%", 100.0)
      .html();
}

std::string calibration_card(const RunSummary& s) {
  Card card("Calibration");
  for (const CalibrationValue& value : s.result.calibration) {
    std::string text = format(value.mean) + " \u00b1 " + format(value.sigma);
    if (!value.observable) text += " (not observable)";
    if (s.truth)
      if (const auto error = s.truth->calibration_error.find(value.name);
          error != s.truth->calibration_error.end())
        text += ", error " + format(error->second);
    card.row(value.name, text);
  }
  return card.html();
}

std::string timing_card(const RunSummary& s) {
  Card card("Timing");
  card.row("steps", std::to_string(s.timing.steps));
  if (s.timing.step_ms)
    card.row("step mean / median",
             format(s.timing.step_ms->mean, "ms") + " / " + format(s.timing.step_ms->p50, "ms"))
        .row("step p95 / max",
             format(s.timing.step_ms->p95, "ms") + " / " + format(s.timing.step_ms->max, "ms"));
  return card.row("wall / CPU", format(s.timing.wall_s, "s") + " / " + format(s.timing.cpu_s, "s"))
      .row("times real time", s.timing.realtime_factor)
      .row("peak memory", s.timing.peak_rss_mb, "MB")
      .html();
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string safe;
  for (const char c : text) switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  return safe;
}

std::string key_figures_html(const RunSummary& summary) {
  std::string html = run_card(summary);
  if (summary.truth) html += path_card(*summary.truth) + map_card(*summary.truth);
  return html + consistency_card(summary) + calibration_card(summary) + timing_card(summary);
}

std::string warnings_html(const RunSummary& summary) {
  if (summary.input.warnings.empty()) return "";
  std::string html = "<section class=\"warnings\"><h2>Warnings</h2><ul>";
  for (const std::string& warning : summary.input.warnings)
    html += "<li>" + escape_html(warning) + "</li>";
  return html + "</ul></section>\n";
}

}  // namespace libslam
