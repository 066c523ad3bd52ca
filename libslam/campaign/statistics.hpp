#pragma once
// What many runs say together.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace libslam {

struct Distribution {
  double mean = 0.0, median = 0.0, p95 = 0.0;
  double sd = 0.0;  ///< of the sample (n - 1); 0 for a single value
};

/// Quantiles interpolate linearly between order statistics. Throws std::invalid_argument when
/// empty.
Distribution summarize(std::vector<double> values);

/// Mean NEES of the n runs of one batch over the updates, against the two-sided 95 % band of
/// chi-square with 3 n degrees of freedom, divided by n (Bar-Shalom, Li & Kirubarajan 2001, 5.4.2).
/// Where only m of the runs have a value, that mean is judged by the band for m.
struct NeesBand {
  int runs = 0;
  std::vector<double> mean;         ///< by update, as many as every run has
  double lower = 0.0, upper = 0.0;  ///< for all runs
  double fraction_in_band = 0.0;
  std::optional<std::size_t> first_exit;  ///< first update above the band
};

/// `runs`: NEES by update; values that are no numbers (a known start pose) are left out, and an
/// update where no run has one. Nothing without runs.
std::optional<NeesBand> average_nees(const std::vector<const std::vector<double>*>& runs);

/// sqrt(sum a / sum b) over paired runs with its 95 % confidence interval.
struct PairedRatio {
  double ratio = 0.0, lower = 0.0, upper = 0.0;
  std::size_t pairs = 0;
};

/// a[i], b[i] >= 0: the mean squared error (or any figure, then with `squared` false and no root)
/// of run i by two filters that saw the same log. Percentile bootstrap over the pairs, 4000
/// resamples, always the same ones (Efron & Tibshirani 1993, chapter 13). With few pairs it covers
/// less than it says, and the interval of a single pair has no width. Nothing without pairs or
/// where all b are zero. Throws std::invalid_argument on unequal numbers.
std::optional<PairedRatio> compare_paired(std::span<const double> a, std::span<const double> b,
                                          bool squared = true);

}  // namespace libslam
