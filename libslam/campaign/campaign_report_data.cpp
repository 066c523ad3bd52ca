#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include <libslam/campaign/campaign_report_data.hpp>
#include <libslam/campaign/figure_lookup.hpp>
#include <libslam/result/report_map_data.hpp>

namespace libslam {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr std::size_t kCurvePoints = 600;      ///< about what a screen can show
constexpr std::size_t kFewestPoints = 50;      ///< below that a curve says nothing
constexpr std::size_t kPointsOfPage = 30'000;  ///< per curve over all cells: a page of a few MB

std::vector<double> numbers_of(const Json* values) {
  std::vector<double> numbers;
  if (values == nullptr || !values->is_array()) return numbers;
  for (const Json& value : *values)
    numbers.push_back(value.is_number() ? value.get<double>() : std::nan(""));
  return numbers;
}

Json pick(std::span<const double> values, std::span<const std::size_t> indices,
          double factor = 1.0) {
  Json out = Json::array();
  for (const std::size_t i : indices) out.push_back(short_number(factor * values[i]));
  return out;
}

Json nees_curve(const Json& cell, std::size_t limit) {
  std::vector<double> mean = numbers_of(value_at(cell, {"nees", "mean"}));
  const std::vector<double> times = numbers_of(value_at(cell, {"nees", "times_s"}));
  mean.resize(std::min(mean.size(), times.size()));
  if (mean.empty()) return nullptr;
  const auto indices = extreme_indices(mean, limit);
  const Json* batches = value_at(cell, {"nees", "batches"});
  const bool has_batch = batches != nullptr && batches->is_array() && !batches->empty();
  return {{"t", pick(times, indices)},
          {"mean", pick(mean, indices)},
          {"lower", short_number(figure_at(cell, {"nees", "lower"}))},
          {"upper", short_number(figure_at(cell, {"nees", "upper"}))},
          {"runs", short_number(has_batch ? figure_at(batches->front(), {"runs"}) : std::nan(""))}};
}

Json error_curves(const Json& cell, std::size_t limit) {
  const Json *errors = value_at(cell, {"example", "errors"}),
             *sigmas = value_at(cell, {"example", "sigmas"});
  const std::vector<double> times = numbers_of(value_at(cell, {"example", "times_s"}));
  if (times.empty() || errors == nullptr || sigmas == nullptr || errors->size() != 3 ||
      sigmas->size() != 3)
    return nullptr;
  Json out = Json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> error = numbers_of(&(*errors)[axis]);
    const std::vector<double> sigma = numbers_of(&(*sigmas)[axis]);
    error.resize(std::min({error.size(), sigma.size(), times.size()}));
    const auto indices = extreme_indices(error, limit);
    const double unit = axis == 2 ? kDegrees : 1.0;
    out.push_back({{"t", pick(times, indices)},
                   {"error", pick(error, indices, unit)},
                   {"bound", pick(sigma, indices, 3.0 * unit)}});
  }
  return out;
}

/// Linear between the order statistics, as the quantiles of campaign.json.
double quantile(std::span<const double> sorted, double probability) {
  const double at = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  return std::lerp(sorted[below], sorted[std::min(below + 1, sorted.size() - 1)],
                   at - static_cast<double>(below));
}

/// Seven quantiles of a figure over the runs that have it; null without any.
Json box_of(const Json& cell, const char* key, double unit = 1.0) {
  std::vector<double> values;
  if (const Json* runs = value_at(cell, {"runs"}))
    for (const Json& run : *runs)
      if (const double value = figure_at(run, {key}); std::isfinite(value))
        values.push_back(unit * value);
  if (values.empty()) return nullptr;
  std::sort(values.begin(), values.end());
  Json out = Json::array();
  for (const double p : {0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0})
    out.push_back(short_number(quantile(values, p)));
  return out;
}

Json ratio_of(const Json& cell) {
  const Json* ratio = value_at(cell, {"comparison", "rmse_position"});
  if (ratio == nullptr) return nullptr;
  return {{"value", short_number(figure_at(*ratio, {"ratio"}))},
          {"lower", short_number(figure_at(*ratio, {"lower"}))},
          {"upper", short_number(figure_at(*ratio, {"upper"}))}};
}

Json cell_data(const Json& cell, std::size_t limit) {
  const bool curves = limit >= kFewestPoints;
  const Json* runs = value_at(cell, {"runs"});
  return {{"done", short_number(figure_at(cell, {"counts", "done"}))},
          {"runs", runs == nullptr ? 0 : runs->size()},
          {"nees", curves ? nees_curve(cell, limit) : nullptr},
          {"errors", curves ? error_curves(cell, limit) : nullptr},
          {"boxes",
           {{"position", box_of(cell, "rmse_position_m")},
            {"heading", box_of(cell, "rmse_heading_rad", kDegrees)},
            {"nees", box_of(cell, "nees_mean")}}},
          {"ratio", ratio_of(cell)},
          {"nees_mean", short_number(figure_at(cell, {"nees", "time_mean"}))}};
}

std::optional<double> parse_number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::vector<std::string> short_names(const Json& point) {
  std::vector<std::string> names;
  for (const auto& [key, value] : point.items()) names.push_back(key.substr(key.rfind('.') + 1));
  if (std::set<std::string>(names.begin(), names.end()).size() == names.size()) return names;
  names.clear();
  for (const auto& [key, value] : point.items()) names.push_back(key);
  return names;
}

/// The points lie on one axis of numbers where the first setting tells them apart.
Json grid_data(const std::vector<const Json*>& points) {
  if (points.size() < 2) return nullptr;
  std::string name;
  for (const std::string& part : short_names(*points.front()))
    name += (name.empty() ? "" : ", ") + part;
  Json values = Json::array();
  std::set<double> distinct;
  for (const Json* point : points)
    if (const auto number = point->empty() ? std::nullopt : parse_number(point->front())) {
      values.push_back(*number);
      distinct.insert(*number);
    }
  if (distinct.size() != points.size()) values = nullptr;
  return {{"name", name}, {"values", values}};
}

std::size_t index_of(Json& names, const Json& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

}  // namespace

std::string point_label(const Json& point) {
  const std::vector<std::string> names = short_names(point);
  std::set<std::string> values;
  for (const auto& [key, value] : point.items()) values.insert(value.get<std::string>());
  std::string label;
  std::size_t i = 0;
  for (const auto& [key, value] : point.items()) {
    label += names[i++] + " = ";
    if (values.size() > 1) label += value.get<std::string>() + (i < names.size() ? ", " : "");
  }
  return values.size() == 1 ? label + *values.begin() : label;
}

std::vector<std::size_t> extreme_indices(std::span<const double> values, std::size_t limit) {
  std::vector<std::size_t> indices;
  const std::size_t count = values.size();
  const std::size_t stretches = count <= limit ? count : limit / 2;
  for (std::size_t s = 0; s < stretches; ++s) {
    const std::size_t begin = s * count / stretches, end = (s + 1) * count / stretches;
    std::size_t least = begin, greatest = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (!std::isfinite(values[least]) || values[i] < values[least]) least = i;
      if (!std::isfinite(values[greatest]) || values[i] > values[greatest]) greatest = i;
    }
    indices.push_back(std::min(least, greatest));
    if (least != greatest) indices.push_back(std::max(least, greatest));
  }
  return indices;
}

Json make_campaign_report_data(const Json& campaign) {
  const Json& cells = campaign.at("cells");
  const std::size_t limit =
      std::min(kCurvePoints, kPointsOfPage / std::max<std::size_t>(1, cells.size()));
  Json variants = Json::array(), points = Json::array();
  std::vector<const Json*> settings;
  for (const Json& cell : cells) {
    const Json& point = cell.at("point");
    if (settings.empty() || *settings.back() != point) {
      settings.push_back(&point);
      points.push_back({{"label", point_label(point)}, {"cells", Json::array()}});
    }
    Json& row = points.back()["cells"];
    const std::size_t variant = index_of(variants, cell.at("variant"));
    while (row.size() <= variant) row.push_back(nullptr);
    row[variant] = cell_data(cell, limit);
  }
  for (Json& point : points)
    while (point["cells"].size() < variants.size()) point["cells"].push_back(nullptr);
  return {{"variants", variants},
          {"grid", grid_data(settings)},
          {"points", points},
          {"curves", limit >= kFewestPoints},
          {"seed", campaign.value("seed", Json())}};
}

}  // namespace libslam
