#include <cmath>
#include <numbers>

#include <libslam/result/stretches.hpp>

namespace libslam {
namespace {

/// Largest of 1, 2, 5 times a power of ten that is not above `value`.
double round_down(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {5.0, 2.0})
    if (factor * decade <= value) return factor * decade;
  return decade;
}

}  // namespace

std::optional<RelativeErrors> average_over_stretches(
    const std::vector<double>& length, double distance_m,
    const std::function<RelativePoseError(std::size_t from, std::size_t to)>& error) {
  if (length.size() < 2) return std::nullopt;
  if (distance_m <= 0.0 && length.back() > 0.0) distance_m = round_down(length.back() / 10.0);
  RelativeErrors errors;
  errors.distance_m = distance_m;
  for (std::size_t i = 0, j = 0; i < length.size() && distance_m > 0.0; ++i) {
    while (j < length.size() && length[j] - length[i] < distance_m) ++j;
    if (j == length.size()) break;
    const RelativePoseError e = error(i, j);
    errors.trans_percent += 100.0 * e.translation_m / distance_m;
    errors.rot_deg_per_m += e.rotation_rad * 180.0 / std::numbers::pi / distance_m;
    ++errors.stretches;
  }
  if (errors.stretches == 0) return std::nullopt;
  errors.trans_percent /= errors.stretches;
  errors.rot_deg_per_m /= errors.stretches;
  return errors;
}

}  // namespace libslam
