#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <vector>

#include <libslam/result/normalized_error.hpp>
#include <libslam/result/report_figures.hpp>
#include <libslam/result/report_html.hpp>

namespace libslam {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr const char* kDash = "\u2013";

/// Roll, pitch and yaw of a pose in space.
std::string angles_text(const Eigen::Quaterniond& rotation) {
  const Eigen::Matrix3d R = rotation.toRotationMatrix();
  const double roll = std::atan2(R(2, 1), R(2, 2));
  const double pitch = std::asin(std::clamp(-R(2, 0), -1.0, 1.0));
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  std::string text;
  for (const double angle : {roll, pitch, yaw})
    text += (text.empty() ? "" : ", ") + format_figure(angle * kDegrees, "\u00b0");
  return text;
}

void add_final_pose(Card& card, const RunSummary::Result& result) {
  if (result.pose)
    card.row("final pose", format_figure(result.pose->x(), "m") + ", " +
                               format_figure(result.pose->y(), "m") + ", " +
                               format_figure(result.pose->z() * kDegrees, "\u00b0"));
  if (!result.pose3d) return;
  const Eigen::Vector3d& p = result.pose3d->position;
  card.row("final position", format_figure(p.x(), "m") + ", " + format_figure(p.y(), "m") + ", " +
                                 format_figure(p.z(), "m"))
      .row("roll, pitch, yaw", angles_text(result.pose3d->rotation));
}

std::string run_card(const RunSummary& s) {
  Card card("Run");
  card.row("status", s.status + " (exit code " + std::to_string(s.exit_code) + ")");
  add_final_pose(card, s.result);
  card.row("landmarks", std::to_string(s.result.landmarks));
  card.row("log",
           std::to_string(s.input.entries) + " entries, " + format_figure(s.input.duration_s, "s"));
  if (s.input.skipped + s.input.repaired > 0)
    card.row("skipped / repaired",
             std::to_string(s.input.skipped) + " / " + std::to_string(s.input.repaired));
  if (s.seed) card.row("seed", std::to_string(*s.seed));
  return card.html();
}

std::string by_axis(const PositionErrors& errors) {
  std::string text =
      format_figure(errors.rmse_x_m, "m") + " / " + format_figure(errors.rmse_y_m, "m");
  if (errors.rmse_z_m) text += " / " + format_figure(*errors.rmse_z_m, "m");
  return text;
}

std::string path_card(const TruthComparison& truth) {
  Card card("Path against truth");
  if (!truth.path) return "";
  const PathErrors& path = *truth.path;
  if (path.raw)
    card.row("ATE raw", path.raw->rmse_m, "m")
        .row("mean / max",
             format_figure(path.raw->mean_m, "m") + " / " + format_figure(path.raw->max_m, "m"))
        .row(path.raw->rmse_z_m ? "x / y / z" : "x / y", by_axis(*path.raw));
  if (path.aligned)
    card.row("ATE aligned", path.aligned->rmse_m, "m")
        .row("mean / max", format_figure(path.aligned->mean_m, "m") + " / " +
                               format_figure(path.aligned->max_m, "m"));
  if (path.heading)
    card.row("heading", path.heading->rmse_rad, "\u00b0", kDegrees)
        .row("heading max", path.heading->max_rad, "\u00b0", kDegrees);
  if (path.rotation)
    card.row("rotation", path.rotation->rmse_rad, "\u00b0", kDegrees)
        .row("rotation max", path.rotation->max_rad, "\u00b0", kDegrees);
  if (truth.path_smoothed && truth.path_smoothed->raw)
    card.row("ATE raw, smoothed", truth.path_smoothed->raw->rmse_m, "m");
  if (truth.path_smoothed && truth.path_smoothed->aligned)
    card.row("ATE aligned, smoothed", truth.path_smoothed->aligned->rmse_m, "m");
  card.row("drift at the end", path.drift_percent, "%");
  if (truth.relative)
    card.row("drift over " + format_figure(truth.relative->distance_m, "m"),
             format_figure(truth.relative->trans_percent, "%") + ", " +
                 format_figure(truth.relative->rot_deg_per_m, "\u00b0/m"));
  return card.row("matched poses", std::to_string(path.poses)).html();
}

void add_relations(Card& card, const std::string& path, const RelationErrors& errors) {
  card.row(path + ", translation", format_figure(errors.trans_mean_m, "m") + " \u00b1 " +
                                       format_figure(errors.trans_std_m, "m"))
      .row(path + ", rotation", format_figure(errors.rot_mean_deg, "\u00b0") + " \u00b1 " +
                                    format_figure(errors.rot_std_deg, "\u00b0"));
}

std::string relations_card(const TruthComparison& truth) {
  if (!truth.relations) return "";
  Card card("Path against relations");
  if (truth.relations_smoothed) add_relations(card, "smoothed", *truth.relations_smoothed);
  add_relations(card, "on line", *truth.relations);
  return card
      .row("matched / unmatched", std::to_string(truth.relations->matched) + " / " +
                                      std::to_string(truth.relations->unmatched))
      .html();
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

std::optional<double> count_of(const std::optional<std::int64_t>& count) {
  return count ? std::optional<double>(static_cast<double>(*count)) : std::nullopt;
}

std::string noise_card(const RunSummary& s) {
  Card card("Adapted noise");
  for (const AdaptedNoise& noise : s.result.noise)
    card.row(noise.name,
             format_figure(noise.sigma) + " (configured " + format_figure(noise.configured) + ")");
  return card.html();
}

std::string events_card(const RunSummary& s) {
  constexpr std::size_t kMost = 12;
  const std::vector<RunEvent>& events = s.health.events;
  Card card("Events");
  for (std::size_t i = 0; i < std::min(kMost, events.size()); ++i)
    card.row("step " + std::to_string(events[i].step), events[i].what);
  if (events.size() > kMost) card.row("and more", std::to_string(events.size() - kMost));
  return card.html();
}

std::string consistency_card(const RunSummary& s) {
  Card card("Consistency");
  if (s.truth && s.truth->nees) {
    const NeesSummary& nees = *s.truth->nees;
    char median[48];
    std::snprintf(median, sizeof median, "NEES median (ideal %.3g)",
                  median_normalized_square(nees.dof));
    card.row(("NEES mean (ideal " + std::to_string(nees.dof) + ")").c_str(), nees.mean)
        .row(median, nees.median);
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
      .row("disturbances", count_of(s.health.disturbances))
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
  if (s.timing.updates && s.timing.updates_without_stretch)
    card.row("updates / without stretch", std::to_string(*s.timing.updates) + " / " +
                                              std::to_string(*s.timing.updates_without_stretch))
        .row("time saved", s.timing.saved_s, "s");
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
  if (summary.truth)
    html += path_card(*summary.truth) + relations_card(*summary.truth) + map_card(*summary.truth);
  return html + consistency_card(summary) + calibration_card(summary) + noise_card(summary) +
         events_card(summary) + timing_card(summary);
}

}  // namespace libslam
