#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

#include <libslam/campaign/campaign_json.hpp>
#include <libslam/campaign/statistics.hpp>
#include <libslam/config/version.hpp>

namespace libslam {

namespace {

using Json = nlohmann::ordered_json;

/// One cell of the grid: the runs of a variant at a point. Null: not done yet.
struct Cell {
  std::vector<const VariantOutcome*> runs;
};

Json to_json(const Distribution& d) {
  return {{"mean", d.mean}, {"median", d.median}, {"p95", d.p95}, {"sd", d.sd}};
}

/// One object like all of them, every number replaced by its distribution over those that have it.
Json summarize_numbers(const std::vector<const Json*>& objects) {
  Json out = Json::object();
  std::vector<std::string> keys;  // a figure may be missing from the first run alone
  for (const Json* object : objects)
    for (const auto& [key, value] : object->items())
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  for (const std::string& key : keys) {
    std::vector<const Json*> children;
    std::vector<double> numbers;
    for (const Json* object : objects) {
      const auto found = object->find(key);
      if (found == object->end()) continue;
      if (found->is_object()) children.push_back(&*found);
      if (found->is_number()) numbers.push_back(found->get<double>());
    }
    if (!children.empty())
      out[key] = summarize_numbers(children);
    else if (!numbers.empty())
      out[key] = to_json(summarize(std::move(numbers)));
  }
  return out;
}

std::vector<const VariantOutcome*> done_runs(const Cell& cell) {
  std::vector<const VariantOutcome*> done;
  for (const VariantOutcome* run : cell.runs)
    if (run != nullptr && run->done()) done.push_back(run);
  return done;
}

Json pooled_errors(const std::vector<const VariantOutcome*>& runs) {
  ErrorSums sum;
  for (const VariantOutcome* run : runs) {
    sum.x += run->sums.x;
    sum.y += run->sums.y;
    sum.heading += run->sums.heading;
    sum.count += run->sums.count;
  }
  if (sum.count == 0) return Json::object();
  const double n = sum.count;
  return {{"rmse_x_m", std::sqrt(sum.x / n)},
          {"rmse_y_m", std::sqrt(sum.y / n)},
          {"rmse_position_m", std::sqrt((sum.x + sum.y) / n)},
          {"rmse_heading_rad", std::sqrt(sum.heading / n)}};
}

/// Of the first observations of a log, since its start [s].
std::vector<double> times_of(std::size_t observations, double period_s) {
  std::vector<double> times;
  for (std::size_t i = 0; i < observations; ++i) times.push_back(static_cast<double>(i) * period_s);
  return times;
}

/// Mean over the observations that have one; NaN, null in JSON, without any.
double time_mean_of(const NeesBand& band) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double value : band.mean)
    if (std::isfinite(value)) {
      sum += value;
      ++count;
    }
  return count > 0 ? sum / static_cast<double>(count) : std::nan("");
}

Json nees_of(const Cell& cell, const CampaignPlan& plan, double observation_period_s) {
  Json out = Json::object();
  Json batches = Json::array();
  const auto runs = static_cast<std::size_t>(plan.campaign.runs);
  double fractions = 0.0, means = 0.0;
  for (std::size_t begin = 0; begin < cell.runs.size(); begin += runs) {
    std::vector<const std::vector<double>*> nees;
    for (std::size_t i = begin; i < begin + runs; ++i)
      if (const VariantOutcome* run = cell.runs[i]; run != nullptr && run->done())
        nees.push_back(&run->nees);
    const auto band = average_nees(nees);
    if (!band) continue;
    const double time_mean = time_mean_of(*band);
    Json first_exit;
    if (band->first_exit)
      first_exit = static_cast<double>(*band->first_exit) * observation_period_s;
    if (batches.empty())
      out = {{"steps", band->mean.size()},
             {"times_s", times_of(band->mean.size(), observation_period_s)},
             {"mean", band->mean},
             {"lower", band->lower},
             {"upper", band->upper},
             {"fraction_in_band", 0.0},
             {"time_mean", 0.0},
             {"first_exit_s", first_exit}};
    fractions += band->fraction_in_band;
    means += time_mean;
    batches.push_back({{"runs", band->runs},
                       {"fraction_in_band", band->fraction_in_band},
                       {"time_mean", time_mean},
                       {"first_exit_s", first_exit}});
  }
  if (batches.empty()) return out;
  out["fraction_in_band"] = fractions / static_cast<double>(batches.size());
  out["time_mean"] = means / static_cast<double>(batches.size());
  out["batches"] = std::move(batches);
  return out;
}

/// One figure of a run, and whether it is a mean square.
struct Figure {
  const char* name;
  bool squared;
  double (*of)(const VariantOutcome&);
};

double truth_figure(const VariantOutcome& run, const char* key) {
  const auto truth = run.figures.find("truth");
  return truth == run.figures.end() ? std::nan("") : truth->value(key, std::nan(""));
}

constexpr Figure kCompared[] = {
    {"rmse_position", true,
     [](const VariantOutcome& r) { return (r.sums.x + r.sums.y) / std::max(1, r.sums.count); }},
    {"rmse_heading", true,
     [](const VariantOutcome& r) { return r.sums.heading / std::max(1, r.sums.count); }},
    {"rmse_map", true,
     [](const VariantOutcome& r) {
       const double rmse = truth_figure(r, "map_rmse_m");
       return rmse * rmse;
     }},
    {"nees", false, [](const VariantOutcome& r) { return truth_figure(r, "nees_mean"); }},
};

Json comparison_of(const Cell& cell, const Cell& reference, const std::string& name) {
  Json out = {{"reference", name}};
  for (const Figure& figure : kCompared) {
    std::vector<double> ours, theirs;
    for (std::size_t i = 0; i < cell.runs.size(); ++i) {
      const VariantOutcome *a = cell.runs[i], *b = reference.runs[i];
      if (a == nullptr || b == nullptr || !a->done() || !b->done()) continue;
      const double x = figure.of(*a), y = figure.of(*b);
      if (!std::isfinite(x) || !std::isfinite(y)) continue;
      ours.push_back(x);
      theirs.push_back(y);
    }
    if (const auto ratio = compare_paired(ours, theirs, figure.squared))
      out[figure.name] = {{"ratio", ratio->ratio},
                          {"lower", ratio->lower},
                          {"upper", ratio->upper},
                          {"pairs", ratio->pairs}};
  }
  return out;
}

Json runs_of(const CampaignPlan& plan, std::size_t point, const Cell& cell,
             const std::vector<std::optional<RunOutcome>>& outcomes) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < cell.runs.size(); ++i) {
    const CampaignTask task = task_of(plan, point * plan.runs_per_point() + i);
    const VariantOutcome* run = cell.runs[i];
    Json row = {{"batch", task.batch}, {"run", task.run}, {"seed", task.seed}};
    row["status"] = run == nullptr ? "not run" : run->status;
    if (run != nullptr && outcomes[task.index]->retried) row["retried"] = true;
    if (run != nullptr && run->done()) {
      const double n = std::max(1, run->sums.count);
      row["rmse_position_m"] = std::sqrt((run->sums.x + run->sums.y) / n);
      row["rmse_heading_rad"] = std::sqrt(run->sums.heading / n);
      if (const double nees = truth_figure(*run, "nees_mean"); std::isfinite(nees))
        row["nees_mean"] = nees;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json counts_of(const Cell& cell) {
  std::map<std::string, int> counts{{"done", 0}, {"diverged", 0}, {"failed", 0}, {"not run", 0}};
  for (const VariantOutcome* run : cell.runs)
    ++counts[run == nullptr ? "not run" : run->status.substr(0, run->status.find(':'))];
  return {{"done", counts["done"]},
          {"diverged", counts["diverged"]},
          {"failed", counts["failed"]},
          {"not_run", counts["not run"]}};
}

Json cell_to_json(const CampaignPlan& plan, std::size_t point, std::size_t variant,
                  const std::vector<Cell>& cells,
                  const std::vector<std::optional<RunOutcome>>& outcomes) {
  const Cell& cell = cells[variant];
  const GridPoint& at = plan.points[point];
  Json settings = Json::object();
  for (const auto& [key, value] : at.settings) settings[key] = value;
  Json out = {{"point", std::move(settings)},
              {"variant", at.variants[variant].name},
              {"counts", counts_of(cell)}};
  const auto done = done_runs(cell);
  if (!done.empty()) {
    std::vector<const Json*> figures;
    for (const VariantOutcome* run : done) figures.push_back(&run->figures);
    const Json summary = summarize_numbers(figures);
    for (const char* key : {"truth", "health", "calibration", "noise"})
      if (summary.contains(key)) out[key] = summary[key];
    out["pooled"] = pooled_errors(done);
    out["nees"] = nees_of(cell, plan, at.scenario.drive.observation_period_s);
    if (variant != plan.reference)
      out["comparison"] =
          comparison_of(cell, cells[plan.reference], at.variants[plan.reference].name);
    const ErrorSeries& series = done.front()->series;
    if (!series.times.empty())
      out["example"] = {
          {"times_s", series.times}, {"errors", series.errors}, {"sigmas", series.sigmas}};
    if (summary.contains("timing")) out["timing"] = summary["timing"];
  }
  out["runs"] = runs_of(plan, point, cell, outcomes);
  return out;
}

}  // namespace

Json campaign_to_json(const CampaignPlan& plan,
                      const std::vector<std::optional<RunOutcome>>& outcomes,
                      const CampaignEnvironment& environment) {
  Json out = {{"program", "slam-campaign"},
              {"version", version()},
              {"git", git_revision()},
              {"config_sha256", environment.config_sha256},
              {"seed", plan.campaign.seed},
              {"runs", plan.campaign.runs},
              {"batches", plan.campaign.batches},
              {"cells", Json::array()}};
  for (std::size_t point = 0; point < plan.points.size(); ++point) {
    const std::size_t variants = plan.points[point].variants.size();
    std::vector<Cell> cells(variants);
    for (std::size_t i = 0; i < plan.runs_per_point(); ++i) {
      const auto& outcome = outcomes[point * plan.runs_per_point() + i];
      for (std::size_t v = 0; v < variants; ++v)
        cells[v].runs.push_back(outcome ? &outcome->variants[v] : nullptr);
    }
    for (std::size_t v = 0; v < variants; ++v)
      out["cells"].push_back(cell_to_json(plan, point, v, cells, outcomes));
  }
  out["timing"] = {{"wall_s", environment.wall_s}, {"workers", environment.workers}};
  return out;
}

}  // namespace libslam
