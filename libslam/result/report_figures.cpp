#include <cstdio>
#include <numbers>
#include <optional>

#include <libslam/result/report_figures.hpp>
#include <libslam/result/report_html.hpp>

namespace libslam {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr const char* kDash = "\u2013";

std::string run_card(const RunSummary& s) {
  Card card("Run");
  card.row("status", s.status + " (exit code " + std::to_string(s.exit_code) + ")");
  if (s.result.pose)
    card.row("final pose", format_figure(s.result.pose->x(), "m") + ", " +
                               format_figure(s.result.pose->y(), "m") + ", " +
                               format_figure(s.result.pose->z() * kDegrees, "\u00b0"));
  card.row("landmarks", std::to_string(s.result.landmarks));
  card.row("log",
           std::to_string(s.input.entries) + " entries, " + format_figure(s.input.duration_s, "s"));
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
        .row("mean / max",
             format_figure(path.raw->mean_m, "m") + " / " + format_figure(path.raw->max_m, "m"))
        .row("x / y", format_figure(path.raw->rmse_x_m, "m") + " / " +
                          format_figure(path.raw->rmse_y_m, "m"));
  if (path.aligned)
    card.row("ATE aligned", path.aligned->rmse_m, "m")
        .row("mean / max", format_figure(path.aligned->mean_m, "m") + " / " +
                               format_figure(path.aligned->max_m, "m"));
  if (path.heading)
    card.row("heading", path.heading->rmse_rad, "\u00b0", kDegrees)
        .row("heading max", path.heading->max_rad, "\u00b0", kDegrees);
  if (truth.relative)
    card.row("drift over " + format_figure(truth.relative->distance_m, "m"),
             format_figure(truth.relative->trans_percent, "%") + ", " +
                 format_figure(truth.relative->rot_deg_per_m, "\u00b0/m"));
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
          (quarters.empty() ? "" : " \u00b7 ") + (mean ? format_figure(*mean) : std::string(kDash));
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
    std::string text = format_figure(value.mean) + " \u00b1 " + format_figure(value.sigma);
    if (!value.observable) text += " (not observable)";
    if (s.truth)
      if (const auto error = s.truth->calibration_error.find(value.name);
          error != s.truth->calibration_error.end())
        text += ", error " + format_figure(error->second);
    card.row(value.name, text);
  }
  return card.html();
}

std::string timing_card(const RunSummary& s) {
  Card card("Timing");
  card.row("steps", std::to_string(s.timing.steps));
  if (s.timing.step_ms)
    card.row("step mean / median", format_figure(s.timing.step_ms->mean, "ms") + " / " +
                                       format_figure(s.timing.step_ms->p50, "ms"))
        .row("step p95 / max", format_figure(s.timing.step_ms->p95, "ms") + " / " +
                                   format_figure(s.timing.step_ms->max, "ms"));
  return card
      .row("wall / CPU",
           format_figure(s.timing.wall_s, "s") + " / " + format_figure(s.timing.cpu_s, "s"))
      .row("times real time", s.timing.realtime_factor)
      .row("peak memory", s.timing.peak_rss_mb, "MB")
      .html();
}

}  // namespace

std::string key_figures_html(const RunSummary& summary) {
  std::string html = run_card(summary);
  if (summary.truth) html += path_card(*summary.truth) + map_card(*summary.truth);
  return html + consistency_card(summary) + calibration_card(summary) + timing_card(summary);
}

}  // namespace libslam
