#include "table.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

namespace libslam {

namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

/// The number at a path of keys, "-" where there is none.
std::string number(const Json& cell, std::initializer_list<const char*> keys, const char* format) {
  const Json* at = &cell;
  for (const char* key : keys) {
    const auto found = at->find(key);
    if (found == at->end()) return "-";
    at = &*found;
  }
  if (!at->is_number()) return "-";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), format, at->get<double>());
  return text.data();
}

std::string ratio(const Json& cell) {
  const auto comparison = cell.find("comparison");
  if (comparison == cell.end() || !comparison->contains("rmse_position")) return "";
  const std::string value = number(*comparison, {"rmse_position", "ratio"}, "%.3f");
  if ((*comparison)["rmse_position"]["pairs"] < 2) return value;  // no interval from a single pair
  return value + " [" + number(*comparison, {"rmse_position", "lower"}, "%.3f") + ", " +
         number(*comparison, {"rmse_position", "upper"}, "%.3f") + "]";
}

std::string point_of(const Json& cell) {
  std::string text;
  for (const auto& [key, value] : cell["point"].items()) {
    text.append(text.empty() ? "" : " ").append(key.substr(key.rfind('.') + 1)).append("=");
    text += value.get<std::string>();
  }
  return text;
}

Row row_of(const Json& cell) {
  const Json& counts = cell["counts"];
  const int done = counts["done"];
  const int total = done + counts["diverged"].get<int>() + counts["failed"].get<int>() +
                    counts["not_run"].get<int>();
  return {point_of(cell),
          cell["variant"].get<std::string>(),
          std::to_string(done) + "/" + std::to_string(total),
          number(cell, {"pooled", "rmse_x_m"}, "%.3f"),
          number(cell, {"pooled", "rmse_y_m"}, "%.3f"),
          number(cell, {"pooled", "rmse_heading_rad"}, "%.4f"),
          number(cell, {"nees", "time_mean"}, "%.2f"),
          number(cell, {"nees", "fraction_in_band"}, "%.3f"),
          number(cell, {"truth", "nees_coverage_95", "mean"}, "%.3f"),
          ratio(cell)};
}

}  // namespace

std::string campaign_table(const Json& campaign) {
  std::vector<Row> rows{{"point", "variant", "runs", "x m", "y m", "heading", "NEES", "in band",
                         "coverage", "position ratio [95 %]"}};
  for (const Json& cell : campaign["cells"]) rows.push_back(row_of(cell));
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text;
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string pad(widths[i] - row[i].size(), ' ');
      if (widths[i] > 0) text += i < 2 ? row[i] + pad + "  " : pad + row[i] + "  ";
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

}  // namespace libslam
