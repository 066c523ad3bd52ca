#pragma once
// Odometry from laser scans.

#include <string>

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `input.scan_matching`.
struct ScanMatchingParameters {
  bool enabled = false;
  double distance = 0.2;
  double turn_deg = 8.0;
  double max_range = 30.0;
  double max_correspondence = 0.5;
  int max_iterations = 30;
  double floor_xy = 0.01;
  double floor_heading_deg = 0.3;
  double min_overlap = 0.5;

  void describe(auto& v) {
    v.value("enabled", enabled,
            {"", "Refine the pose increments of the log by matching laser scans."});
    v.value("distance", distance,
            {"m", "Scans are matched with a reference scan that is renewed so far from it.", 1e-3});
    v.value("turn_deg", turn_deg, {"deg", "The reference is renewed after this turn, too.", 0.1});
    v.value("max_range", max_range, {"m", "Farther beams do not take part.", 0.1});
    v.value("max_correspondence", max_correspondence,
            {"m", "Points farther apart than this are no pair, at the start of the search.", 1e-3});
    v.value("max_iterations", max_iterations, {"1", "Most iterations of one match.", 1, 1000});
    v.value("floor_xy", floor_xy,
            {"m", "Standard deviation of a match that the points do not explain.", 0});
    v.value("floor_heading_deg", floor_heading_deg, {"deg", "The same of its turn.", 0});
    v.value("min_overlap", min_overlap,
            {"1", "A match with a smaller share of paired points is dropped.", 0, 1});
  }
};

}  // namespace libslam
