#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <stdexcept>
#include <utility>

#include <libslam/campaign/statistics.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {

namespace {

constexpr int kResamples = 4000;
constexpr std::uint64_t kBootstrapSeed = 20061101;

double quantile(const std::vector<double>& sorted, double probability) {
  const double at = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double part = at - static_cast<double>(below);
  return sorted[below] + part * (sorted[above] - sorted[below]);
}

struct Band {
  double lower = 0.0, upper = 0.0;
};

/// Of the mean of so many values of chi-square with 3 degrees of freedom.
Band nees_band(int values) {
  return {chi_square_quantile(0.025, 3 * values) / values,
          chi_square_quantile(0.975, 3 * values) / values};
}

/// The mean of what the runs have at update k, and how many of them have something.
std::pair<double, int> mean_at(const std::vector<const std::vector<double>*>& runs, std::size_t k) {
  double sum = 0.0;
  int count = 0;
  for (const auto* run : runs) {
    if (!std::isfinite((*run)[k])) continue;
    sum += (*run)[k];
    ++count;
  }
  return {count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN(), count};
}

}  // namespace

Distribution summarize(std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("no values to summarize");
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  Distribution d;
  d.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  d.median = quantile(values, 0.5);
  d.p95 = quantile(values, 0.95);
  double squares = 0.0;
  for (const double value : values) squares += (value - d.mean) * (value - d.mean);
  d.sd = values.size() > 1 ? std::sqrt(squares / (n - 1.0)) : 0.0;
  return d;
}

std::optional<NeesBand> average_nees(const std::vector<const std::vector<double>*>& runs) {
  if (runs.empty()) return std::nullopt;
  std::size_t updates = std::numeric_limits<std::size_t>::max();
  for (const auto* run : runs) updates = std::min(updates, run->size());
  NeesBand band;
  band.runs = static_cast<int>(runs.size());
  std::map<int, Band> bands{{band.runs, nees_band(band.runs)}};
  band.lower = bands[band.runs].lower;
  band.upper = bands[band.runs].upper;
  std::size_t counted = 0, inside = 0;
  for (std::size_t k = 0; k < updates; ++k) {
    const auto [mean, count] = mean_at(runs, k);
    band.mean.push_back(mean);
    if (count == 0) continue;
    if (!bands.contains(count)) bands[count] = nees_band(count);
    const Band& limits = bands[count];
    ++counted;
    inside += mean >= limits.lower && mean <= limits.upper;
    if (!band.first_exit && mean > limits.upper) band.first_exit = k;
  }
  if (counted > 0)
    band.fraction_in_band = static_cast<double>(inside) / static_cast<double>(counted);
  return band;
}

std::optional<PairedRatio> compare_paired(std::span<const double> a, std::span<const double> b,
                                          bool squared) {
  if (a.size() != b.size()) throw std::invalid_argument("unequal numbers of paired runs");
  const double total = std::accumulate(b.begin(), b.end(), 0.0);
  if (a.empty() || !(total > 0.0)) return std::nullopt;
  const auto ratio_of = [squared](double above, double below) {
    return squared ? std::sqrt(above / below) : above / below;
  };
  std::mt19937_64 random(kBootstrapSeed);
  std::vector<double> ratios;
  for (int r = 0; r < kResamples; ++r) {
    double above = 0.0, below = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const std::size_t pick = random() % a.size();
      above += a[pick];
      below += b[pick];
    }
    if (below > 0.0) ratios.push_back(ratio_of(above, below));
  }
  std::sort(ratios.begin(), ratios.end());
  PairedRatio result;
  result.ratio = ratio_of(std::accumulate(a.begin(), a.end(), 0.0), total);
  result.lower = quantile(ratios, 0.025);
  result.upper = quantile(ratios, 0.975);
  result.pairs = a.size();
  return result;
}

}  // namespace libslam
