#pragma once
// Pieces that the time plots of the report are made of.

#include <cstddef>

#include <nlohmann/json.hpp>

#include <libslam/result/series_envelope.hpp>

namespace libslam {

/// Buckets of a plot: a little more than it has pixels.
inline constexpr std::size_t kPlotBuckets = 1400;

/// Mean that forgets: over about a fortieth of a series of `length` values. NaN passes through
/// without effect.
class MovingMean {
 public:
  explicit MovingMean(std::size_t length);
  double add(double value);

 private:
  double rate_, weight_ = 0.0, sum_ = 0.0;
};

enum class Edge { low, high };

/// The abscissas of a series, as the `t` of a plot.
nlohmann::ordered_json abscissas(const SeriesEnvelope& series);
nlohmann::ordered_json channel(const SeriesEnvelope& series, std::size_t index, Edge edge);
/// A panel with the envelope of channel `value`.
nlohmann::ordered_json panel(const char* label, const char* unit, const SeriesEnvelope& series,
                             std::size_t value);
/// The band between the lower edge of one channel and the upper edge of another.
nlohmann::ordered_json band(const char* name, const SeriesEnvelope& series, std::size_t low,
                            std::size_t high);

}  // namespace libslam
