#pragma once
// Straight lines in laser scans.

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `frontend.lines`.
struct ScanLinesParameters {
  double sigma_range = 0.015;
  double floor_alpha_deg = 1.2;
  double floor_r = 0.03;
  double floor_length = 1.0;
  int min_points = 6;
  double min_length = 0.8;
  double break_angle_deg = 10.0;
  double split_distance = 0.06;
  double merge_gap = 1.0;

  void describe(auto& v) {
    v.value("sigma_range", sigma_range, {"m", "Standard deviation of the range of a beam.", 1e-6});
    v.value("floor_alpha_deg", floor_alpha_deg,
            {"deg",
             "Standard deviation of the direction of a line that the noise of the beams does not "
             "explain: walls are not straight, and the error does not average out over points.",
             0, 45});
    v.value("floor_r", floor_r,
            {"m", "The same of its distance from the sensor, at the centre of the segment.", 0});
    v.value("floor_length", floor_length,
            {"m",
             "The floor of the direction is wider for short segments: times sqrt(1 + (floor_length "
             "/ length)^2).",
             0});
    v.value("min_points", min_points, {"1", "Fewest points of a line.", 3, 100000});
    v.value("min_length", min_length, {"m", "Shortest line.", 1e-3});
    v.value("break_angle_deg", break_angle_deg,
            {"deg",
             "Two neighbouring points belong to different surfaces if a surface through both "
             "would be steeper against the beam than this.",
             0.1, 89});
    v.value("split_distance", split_distance,
            {"m",
             "A run of points is split where one is farther from the chord than this, and no point "
             "of a line is farther from it.",
             1e-4});
    v.value("merge_gap", merge_gap,
            {"m",
             "Segments on one line become one feature across a gap up to this (doors, people in "
             "front of a wall).",
             0});
  }
};

}  // namespace libslam
