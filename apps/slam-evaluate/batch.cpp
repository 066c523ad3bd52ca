#include "batch.hpp"

#include <chrono>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include <libslam/config/digest.hpp>
#include <libslam/config/yaml_loader.hpp>
#include <libslam/pipeline/factory.hpp>
#include <libslam/pipeline/landmark_identity.hpp>
#include <libslam/result/atomic_file.hpp>

#include "table.hpp"

namespace libslam::evaluate {
namespace {

using Json = nlohmann::ordered_json;

std::string log_of(const std::filesystem::path& directory, const RunSummary& summary) {
  if (!summary.input.file)
    throw std::runtime_error((directory / "run.json").string() + " names no log");
  const std::string& log = *summary.input.file;
  if (!std::filesystem::is_regular_file(log))
    throw std::runtime_error(log + ": the log of " + directory.string() + " is not there");
  if (summary.input_sha256 && *summary.input_sha256 != sha256_of_file(log))
    throw std::runtime_error(log + ": not the log that " + directory.string() + " was made from");
  return log;
}

Json entry_of(const BatchEvaluation& run) {
  Json entry = {{"run", run.name}};
  entry.update(libslam::to_json(run.comparison));
  entry["timing"] = {{"solve_s", run.seconds}};
  return entry;
}

std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

EvaluatedRun column(const std::string& name, const BatchAnswer& answer) {
  EvaluatedRun run{name, {}};
  run.summary.result.calibration = answer.calibration;
  run.summary.result.landmarks = static_cast<std::int64_t>(answer.map.size());
  run.summary.truth = answer.truth;
  return run;
}

std::string metres(const std::optional<double>& value) {
  if (!value) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.4g m", *value);
  return text;
}

std::string raw_rmse(const std::optional<PathErrors>& path) {
  if (!path || !path->raw) return "-";
  return metres(path->raw->rmse_m);
}

}  // namespace

BatchEvaluation evaluate_batch(const std::filesystem::path& directory, const std::string& name,
                               const RunSummary& summary, const GroundTruth& truth,
                               int on_line_steps) {
  const std::string log = log_of(directory, summary);
  const Parameters parameters = load_yaml(directory / "config.yaml");
  const FilterReplay replay = replay_filter(log, parameters, summary.timing.steps);
  const EkfSlamParts parts = make_filter_parts(parameters);
  const auto begin = std::chrono::steady_clock::now();
  const BatchResult batch = optimize_batch(replay.log, parts, replay.estimate);
  const LandmarkIdentity identity = landmark_identity(parameters);
  BatchEvaluation run{name, compare_with_batch(replay, batch, truth, identity), 0.0};
  if (on_line_steps > 0)
    run.comparison.on_line = compare_on_line(replay, parts, batch, truth, on_line_steps);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  replace_file(directory / "batch.json", dump(entry_of(run)));
  return run;
}

std::string to_text(const BatchEvaluation& run, bool detailed) {
  const BatchComparison& c = run.comparison;
  const std::vector<EvaluatedRun> columns = {column("filter", c.filter), column("batch", c.batch)};
  const BatchDistance& d = c.distance;
  std::string text = run.name + '\n' + to_table(columns, figures_of(columns, detailed)) +
                     "distance: landmarks RMSE " + metres(d.landmarks_rmse_m) + " raw, " +
                     metres(d.landmarks_rmse_aligned_m) + " aligned, max " +
                     metres(d.landmarks_max_m) + "; path (as it was on line) RMSE " +
                     metres(d.path_rmse_m) + ", max " + metres(d.path_max_m) + "; last pose " +
                     metres(d.end_m) + '\n';
  if (c.on_line)
    text += "with the knowledge of the time, at " + std::to_string(c.on_line->poses) +
            " steps: path RMSE raw " + raw_rmse(c.on_line->filter) + ", batch " +
            raw_rmse(c.on_line->batch) + ", distance " + metres(c.on_line->distance_rmse_m) + '\n';
  char solved[256];
  std::snprintf(solved, sizeof solved,
                "solved: chi-square %.6g -> %.6g, %d degrees of freedom, %d poses, %d iterations, "
                "%.2f s%s\n",
                c.optimization.chi_square_before, c.optimization.chi_square,
                c.optimization.degrees_of_freedom, c.optimization.poses, c.optimization.iterations,
                run.seconds, c.optimization.converged ? "" : ", NOT CONVERGED");
  return text + solved;
}

std::string to_json(const std::vector<BatchEvaluation>& runs) {
  Json list = Json::array();
  for (const BatchEvaluation& run : runs) list.push_back(entry_of(run));
  return dump({{"runs", list}});
}

}  // namespace libslam::evaluate
