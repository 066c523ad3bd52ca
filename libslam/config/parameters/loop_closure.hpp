#pragma once
// Loops that ordinary association no longer closes.

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `filter.loop_closure`.
struct LoopClosureParameters {
  bool enabled = false;
  double min_way = 15.0;
  double window_xy = 4.0;
  double window_heading_deg = 20.0;
  double min_score = 0.6;
  double min_margin = 0.1;
  int min_pairs = 3;
  double joint_probability = 0.99;
  int confirmations = 2;

  void describe(auto& v) {
    v.value("enabled", enabled,
            {"",
             "Search the walls of the map that should be in view again where the robot comes back "
             "and association does not recognize them."});
    v.value("min_way", min_way,
            {"m", "A place is an old one if it was left behind by so long a way.", 0});
    v.value("window_xy", window_xy,
            {"m", "The pose is searched so far around the estimate.", 1e-3, 100});
    v.value("window_heading_deg", window_heading_deg,
            {"deg", "The heading is searched so far around the estimate.", 0.1, 180});
    v.value("min_score", min_score,
            {"1", "Least share of the view that must lie on the old map.", 0, 1});
    v.value("min_margin", min_margin,
            {"1", "A pose elsewhere in the window must explain so much less of the view.", 0, 1});
    v.value("min_pairs", min_pairs,
            {"1", "Fewest pairs of lines, not all parallel, that must agree.", 2, 100});
    v.value(
        "joint_probability", joint_probability,
        {"1", "They agree if their joint misfit is below this chi-square probability.", 1e-6, 1});
    v.value("confirmations", confirmations,
            {"1", "Searches from different places that must find the same correction.", 1, 100});
  }
};

}  // namespace libslam
