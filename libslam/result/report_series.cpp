#include <algorithm>
#include <cmath>
#include <limits>

#include <libslam/result/report_map_data.hpp>
#include <libslam/result/report_series.hpp>

namespace libslam {

using Json = nlohmann::ordered_json;

MovingMean::MovingMean(std::size_t length)
    : rate_(std::min(1.0, 40.0 / static_cast<double>(std::max<std::size_t>(1, length)))) {}

double MovingMean::add(double value) {
  if (!std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
  weight_ += rate_ * (1.0 - weight_);  // corrects for the start from nothing
  sum_ += rate_ * (value - sum_);
  return sum_ / weight_;
}

Json abscissas(const SeriesEnvelope& series) {
  Json t = Json::array();
  for (std::size_t i = 0; i < series.size(); ++i) t.push_back(short_number(series.abscissa(i)));
  return t;
}

Json channel(const SeriesEnvelope& series, std::size_t index, Edge edge) {
  Json values = Json::array();
  for (std::size_t i = 0; i < series.size(); ++i) {
    const auto range = series.range(i, index);
    values.push_back(short_number(static_cast<double>(edge == Edge::low ? range.low : range.high)));
  }
  return values;
}

Json panel(const char* label, const char* unit, const SeriesEnvelope& series, std::size_t value) {
  return {{"label", label},
          {"unit", unit},
          {"low", channel(series, value, Edge::low)},
          {"high", channel(series, value, Edge::high)}};
}

Json band(const char* name, const SeriesEnvelope& series, std::size_t low, std::size_t high) {
  return {{"name", name},
          {"low", channel(series, low, Edge::low)},
          {"high", channel(series, high, Edge::high)}};
}

}  // namespace libslam
