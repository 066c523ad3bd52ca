#include "table.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <numbers>
#include <set>

#include <nlohmann/json.hpp>

#include <libslam/result/normalized_error.hpp>
#include <libslam/result/truth_json.hpp>

namespace libslam::evaluate {
namespace {

using Value = std::optional<double>;
using Getter = std::function<Value(const RunSummary&)>;

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// A getter for a member of an optional part of the comparison.
template <typename Part>
Getter of_truth(std::optional<Part> TruthComparison::*part, std::function<Value(const Part&)> get) {
  return [part, get](const RunSummary& s) -> Value {
    if (!s.truth || !((*s.truth).*part)) return std::nullopt;
    return get(*((*s.truth).*part));
  };
}

Getter of_path(std::function<Value(const PathErrors&)> get) {
  return of_truth<PathErrors>(&TruthComparison::path, std::move(get));
}
Getter of_position(std::optional<PathErrors::Position> PathErrors::*placement,
                   double PathErrors::Position::*figure) {
  return of_path([=](const PathErrors& path) {
    return path.*placement ? Value((*(path.*placement)).*figure) : std::nullopt;
  });
}
Getter of_smoothed(std::optional<PathErrors::Position> PathErrors::*placement) {
  return of_truth<PathErrors>(&TruthComparison::path_smoothed, [=](const PathErrors& path) {
    return path.*placement ? Value((path.*placement)->rmse_m) : std::nullopt;
  });
}
Getter of_heading(double PathErrors::Heading::*figure) {
  return of_path([=](const PathErrors& path) {
    return path.heading ? Value((*path.heading).*figure * kDegrees) : std::nullopt;
  });
}
Getter of_rotation(double RotationErrors::*figure) {
  return of_path([=](const PathErrors& path) {
    return path.rotation ? Value((*path.rotation).*figure * kDegrees) : std::nullopt;
  });
}
Getter of_nees(std::function<Value(const NeesSummary&)> get) {
  return of_truth<NeesSummary>(&TruthComparison::nees, std::move(get));
}
Getter of_map(std::function<Value(const MapErrors&)> get) {
  return of_truth<MapErrors>(&TruthComparison::map, std::move(get));
}
Getter of_relative(double RelativeErrors::*figure) {
  return of_truth<RelativeErrors>(&TruthComparison::relative,
                                  [=](const RelativeErrors& r) { return r.*figure; });
}

using Relations = std::optional<RelationErrors> TruthComparison::*;

Getter of_relations(Relations path, double RelationErrors::*figure) {
  return of_truth<RelationErrors>(path, [=](const RelationErrors& r) { return r.*figure; });
}

Value cpu_ms_per_step(const RunSummary& s) {
  if (s.timing.steps < 1) return std::nullopt;
  return 1e3 * s.timing.cpu_s / static_cast<double>(s.timing.steps);
}

struct Description {
  std::string key, label;
  Getter get;
  bool detail = false;
};

void describe_path(std::vector<Description>& list) {
  using P = PathErrors::Position;
  const auto raw = &PathErrors::raw, aligned = &PathErrors::aligned;
  list.push_back({"ate_rmse_m", "path RMSE raw [m]", of_position(raw, &P::rmse_m)});
  list.push_back({"ate_mean_m", "  mean [m]", of_position(raw, &P::mean_m), true});
  list.push_back({"ate_max_m", "  max [m]", of_position(raw, &P::max_m), true});
  list.push_back({"rmse_x_m", "  x RMSE [m]", of_position(raw, &P::rmse_x_m), true});
  list.push_back({"rmse_y_m", "  y RMSE [m]", of_position(raw, &P::rmse_y_m), true});
  list.push_back(
      {"rmse_z_m", "  z RMSE [m]",
       of_path([](const PathErrors& p) { return p.raw ? p.raw->rmse_z_m : std::nullopt; }), true});
  list.push_back({"ate_rmse_aligned_m", "path RMSE aligned [m]", of_position(aligned, &P::rmse_m)});
  list.push_back({"ate_mean_aligned_m", "  mean aligned [m]", of_position(aligned, &P::mean_m)});
  list.push_back({"ate_max_aligned_m", "  max aligned [m]", of_position(aligned, &P::max_m), true});
  list.push_back({"smoothed_rmse_m", "  smoothed, raw [m]", of_smoothed(raw)});
  list.push_back({"smoothed_rmse_aligned_m", "  smoothed, aligned [m]", of_smoothed(aligned)});
  list.push_back(
      {"rmse_heading_deg", "heading RMSE [deg]", of_heading(&PathErrors::Heading::rmse_rad)});
  list.push_back(
      {"max_heading_deg", "  max [deg]", of_heading(&PathErrors::Heading::max_rad), true});
  list.push_back(
      {"rmse_rotation_deg", "rotation RMSE [deg]", of_rotation(&RotationErrors::rmse_rad)});
  list.push_back({"max_rotation_deg", "  max [deg]", of_rotation(&RotationErrors::max_rad), true});
  list.push_back({"drift_percent", "drift at the end [%]",
                  of_path([](const PathErrors& p) { return p.drift_percent; })});
  list.push_back(
      {"rpe_distance_m", "drift over [m]", of_relative(&RelativeErrors::distance_m), true});
  list.push_back({"rpe_trans_percent", "  drift [%]", of_relative(&RelativeErrors::trans_percent)});
  list.push_back(
      {"rpe_rot_deg_per_m", "  drift [deg/m]", of_relative(&RelativeErrors::rot_deg_per_m)});
  list.push_back(
      {"poses", "poses matched", of_path([](const PathErrors& p) { return p.poses; }), true});
}

void describe_relations(std::vector<Description>& list, Relations path, const std::string& name,
                        const std::string& label) {
  using E = RelationErrors;
  list.push_back(
      {name + "_trans_mean_m", label + ", translation [m]", of_relations(path, &E::trans_mean_m)});
  list.push_back({name + "_trans_std_m", "  deviation [m]", of_relations(path, &E::trans_std_m)});
  list.push_back(
      {name + "_rot_mean_deg", label + ", rotation [deg]", of_relations(path, &E::rot_mean_deg)});
  list.push_back({name + "_rot_std_deg", "  deviation [deg]", of_relations(path, &E::rot_std_deg)});
  list.push_back({name + "_matched", "  matched",
                  of_truth<E>(path, [](const E& r) { return r.matched; }), true});
}

/// Ideal value of a figure of NEES, by the degrees of freedom of the runs: "(3)", "(3 or 6)".
std::string nees_ideal(const std::vector<EvaluatedRun>& runs, double (*ideal)(int dof)) {
  std::set<int> dofs;
  for (const EvaluatedRun& run : runs)
    if (run.summary.truth && run.summary.truth->nees) dofs.insert(run.summary.truth->nees->dof);
  std::string text;
  for (const int dof : dofs) {
    char value[32];
    std::snprintf(value, sizeof value, "%.3g", ideal(dof));
    text += (text.empty() ? "" : " or ") + std::string(value);
  }
  return " (" + text + ")";
}

void describe_consistency(std::vector<Description>& list, const std::vector<EvaluatedRun>& runs) {
  const auto mean = [](int dof) { return static_cast<double>(dof); };
  list.push_back({"nees_mean", "NEES mean" + nees_ideal(runs, mean),
                  of_nees([](const NeesSummary& n) { return n.mean; })});
  list.push_back({"nees_median", "NEES median" + nees_ideal(runs, median_normalized_square),
                  of_nees([](const NeesSummary& n) { return n.median; })});
  list.push_back(
      {"nees_in_95", "NEES in 95 % (.95)", of_nees([](const NeesSummary& n) { return n.in_95; })});
  for (std::size_t q = 0; q < 4; ++q)
    list.push_back({"nees_quarter_" + std::to_string(q + 1), "  quarter " + std::to_string(q + 1),
                    of_nees([q](const NeesSummary& n) { return n.quarter_mean[q]; })});
  list.push_back(
      {"nis_mean", "NIS per dof (1)", [](const RunSummary& s) { return s.health.nis_mean; }});
  list.push_back(
      {"nis_in_95", "NIS in 95 % (.95)", [](const RunSummary& s) { return s.health.nis_in_95; }});
}

void describe_map(std::vector<Description>& list) {
  list.push_back(
      {"map_rmse_m", "map RMSE raw [m]", of_map([](const MapErrors& m) { return m.rmse_m; })});
  list.push_back({"map_rmse_aligned_m", "map RMSE aligned [m]",
                  of_map([](const MapErrors& m) { return m.rmse_aligned_m; })});
  list.push_back({"landmarks", "landmarks",
                  [](const RunSummary& s) { return static_cast<double>(s.result.landmarks); }});
  list.push_back(
      {"landmarks_missed", "  missed", of_map([](const MapErrors& m) { return m.missed; })});
  list.push_back({"landmarks_duplicate", "  duplicate",
                  of_map([](const MapErrors& m) { return m.duplicates; })});
}

void describe_calibration(std::vector<Description>& list, const std::vector<EvaluatedRun>& runs) {
  std::set<std::string> names;
  for (const EvaluatedRun& run : runs)
    for (const CalibrationValue& value : run.summary.result.calibration) names.insert(value.name);
  for (const std::string& name : names) {
    const auto get = [name](double CalibrationValue::*figure) -> Getter {
      return [=](const RunSummary& s) -> Value {
        for (const CalibrationValue& value : s.result.calibration)
          if (value.name == name) return value.*figure;
        return std::nullopt;
      };
    };
    list.push_back({name, name, get(&CalibrationValue::mean)});
    list.push_back({"sigma_" + name, "  sigma", get(&CalibrationValue::sigma)});
    list.push_back({"error_" + name, "  error", [name](const RunSummary& s) -> Value {
                      if (!s.truth) return std::nullopt;
                      const auto found = s.truth->calibration_error.find(name);
                      return found == s.truth->calibration_error.end() ? std::nullopt
                                                                       : Value(found->second);
                    }});
  }
}

std::string cell(const Value& value) {
  if (!value) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", *value);
  return text;
}

std::string pad(const std::string& text, std::size_t width, bool left) {
  const std::string blanks(width - std::min(width, text.size()), ' ');
  return left ? text + blanks : blanks + text;
}

}  // namespace

std::vector<Figure> figures_of(const std::vector<EvaluatedRun>& runs, bool detailed) {
  std::vector<Description> list;
  describe_path(list);
  describe_relations(list, &TruthComparison::relations_smoothed, "relations_smoothed",
                     "smoothed relations");
  describe_relations(list, &TruthComparison::relations, "relations", "relations");
  describe_consistency(list, runs);
  describe_map(list);
  describe_calibration(list, runs);
  list.push_back({"cpu_ms_per_step", "CPU per step [ms]", cpu_ms_per_step});
  list.push_back(
      {"cpu_s", "  total [s]", [](const RunSummary& s) { return s.timing.cpu_s; }, true});

  std::vector<Figure> figures;
  for (const Description& description : list) {
    if (description.detail && !detailed) continue;
    Figure figure{description.key, description.label, {}};
    for (const EvaluatedRun& run : runs) figure.values.push_back(description.get(run.summary));
    if (std::any_of(figure.values.begin(), figure.values.end(),
                    [](const Value& v) { return v.has_value(); }))
      figures.push_back(std::move(figure));
  }
  return figures;
}

std::string to_table(const std::vector<EvaluatedRun>& runs, const std::vector<Figure>& figures) {
  std::size_t label_width = 0, width = 9;
  for (const Figure& figure : figures) label_width = std::max(label_width, figure.label.size());
  for (const EvaluatedRun& run : runs) width = std::max(width, run.name.size());
  std::string text = pad("", label_width, true);
  for (const EvaluatedRun& run : runs) text += "  " + pad(run.name, width, false);
  text += '\n';
  for (const Figure& figure : figures) {
    text += pad(figure.label, label_width, true);
    for (const Value& value : figure.values) text += "  " + pad(cell(value), width, false);
    text += '\n';
  }
  return text;
}

std::string to_csv(const std::vector<EvaluatedRun>& runs, const std::vector<Figure>& figures) {
  std::string text = "run";
  for (const Figure& figure : figures) text += ',' + figure.key;
  text += '\n';
  for (std::size_t i = 0; i < runs.size(); ++i) {
    text += runs[i].name;
    for (const Figure& figure : figures) {
      text += ',';
      if (figure.values[i]) text += nlohmann::json(*figure.values[i]).dump();
    }
    text += '\n';
  }
  return text;
}

std::string to_json(const std::vector<EvaluatedRun>& runs) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const EvaluatedRun& run : runs) {
    nlohmann::ordered_json entry = {{"run", run.name},
                                    {"status", run.summary.status},
                                    {"exit_code", run.summary.exit_code},
                                    {"landmarks", run.summary.result.landmarks}};
    if (const Value cpu = cpu_ms_per_step(run.summary)) entry["cpu_ms_per_step"] = *cpu;
    if (run.summary.truth) entry["truth"] = truth_to_json(*run.summary.truth);
    list.push_back(entry);
  }
  return nlohmann::ordered_json{{"runs", list}}.dump(
             2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
         "\n";
}

}  // namespace libslam::evaluate
