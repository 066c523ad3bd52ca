#include "summary_text.hpp"

#include <cstdio>
#include <string>

namespace libslam {

namespace fs = std::filesystem;

namespace {

std::string number(double value, const char* format = "%.4g") {
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

void say_path(const std::string& name, const PathErrors& path, Console& console) {
  if (path.raw) console.say("  " + name + " error (RMSE): " + number(path.raw->rmse_m) + " m raw");
  if (path.aligned)
    console.say("  " + name + " error (RMSE): " + number(path.aligned->rmse_m) + " m aligned");
}

void say_relations(const std::string& path, const RelationErrors& errors, Console& console) {
  console.say("  relations, " + path + ": " + number(errors.trans_mean_m) + " m, " +
              number(errors.rot_mean_deg) + " deg");
}

}  // namespace

void report(const RunSummary& summary, const fs::path& directory, Console& console) {
  const auto& timing = summary.timing;
  console.say(summary.status + ": " + std::to_string(timing.steps) + " steps, " +
              std::to_string(summary.result.landmarks) + " landmarks, " + number(timing.wall_s) +
              " s");
  for (const auto& parameter : summary.result.calibration)
    console.say("  " + parameter.name + " = " + number(parameter.mean, "%.5f") + " +- " +
                number(parameter.sigma, "%.5f") +
                (parameter.observable ? "" : "  (not observable in this log)"));
  if (summary.truth && summary.truth->path) say_path("path", *summary.truth->path, console);
  if (summary.truth && summary.truth->path_smoothed)
    say_path("smoothed path", *summary.truth->path_smoothed, console);
  if (summary.truth && summary.truth->relations_smoothed)
    say_relations("smoothed path", *summary.truth->relations_smoothed, console);
  if (summary.truth && summary.truth->relations)
    say_relations("on line", *summary.truth->relations, console);
  if (summary.truth && summary.truth->map && summary.truth->map->rmse_aligned_m)
    console.say("  map error (RMSE): " + number(*summary.truth->map->rmse_aligned_m) +
                " m aligned, " + std::to_string(summary.truth->map->missed) + " missed, " +
                std::to_string(summary.truth->map->duplicates) + " duplicates");
  if (summary.truth && summary.truth->nees)
    console.say("  mean NEES of the pose: " + number(summary.truth->nees->mean) + " (ideal " +
                std::to_string(summary.truth->nees->dof) + ")");
  for (const auto& warning : summary.input.warnings) console.warn("warning: " + warning);
  const fs::path page = directory / "report.html";
  console.say((fs::exists(page) ? "report: " + page.string() : "results: " + directory.string()));
}

void report_details(const RunSummary& summary, Console& console) {
  const auto& input = summary.input;
  console.say("  log: " + std::to_string(input.entries) + " entries, " +
              std::to_string(input.observations) + " observations, " + number(input.duration_s) +
              " s; " + std::to_string(input.skipped) + " skipped, " +
              std::to_string(input.repaired) + " repaired");
  if (summary.health.nis_mean)
    console.say("  NIS per degree of freedom: " + number(*summary.health.nis_mean) + " (ideal 1)");
  if (summary.health.gated_fraction)
    console.say("  gated: " + number(100.0 * *summary.health.gated_fraction) + " %");
  for (const auto& [phase, seconds] : summary.timing.phases)
    console.say("  " + phase + ": " + number(seconds) + " s");
}

void report_doubts(const RunSummary& summary, const GroundTruth& truth, Console& console) {
  constexpr double kAbsurd = 3.0;
  if (summary.health.nis_mean && *summary.health.nis_mean > kAbsurd)
    console.warn(
        "warning: innovations are " + number(*summary.health.nis_mean) +
        " times what the configured noise allows (NIS per degree of freedom): the noise is "
        "too small for this log, or the association wrong");
  if (!truth.path.poses.empty() && !(summary.truth && summary.truth->path))
    console.warn("warning: the true path does not overlap the log in time: no comparison");
}

}  // namespace libslam
