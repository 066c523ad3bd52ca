#pragma once
// Relative errors over stretches of equal length of a path.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace libslam {

/// Relative errors over stretches of `distance_m` of the true path: the error of the relative pose
/// divided by the distance, averaged over all stretches (one from every matched pose). Geiger et
/// al., CVPR 2012.
struct RelativeErrors {
  double distance_m = 0;
  int stretches = 0;
  double trans_percent = 0, rot_deg_per_m = 0;
};

/// Error of the relative pose of two matched poses.
struct RelativePoseError {
  double translation_m, rotation_rad;
};

/// Averages `error` (of the matches `from` and `to`) over all stretches of a path whose length up
/// to each match is `length` [m]. `distance_m` 0 stands for a tenth of the path, rounded down to 1,
/// 2 or 5 times a power of ten. Nothing where the path is shorter than the distance.
std::optional<RelativeErrors> average_over_stretches(
    const std::vector<double>& length, double distance_m,
    const std::function<RelativePoseError(std::size_t from, std::size_t to)>& error);

}  // namespace libslam
