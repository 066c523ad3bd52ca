#pragma once
// Loops that ordinary association no longer closes.

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `filter.loop_closure`.
struct LoopClosureParameters {
  bool enabled = false;
  double min_way = 15.0;
  double window_xy = 6.0;
  double window_heading_deg = 20.0;
  double min_score = 0.55;
  double min_margin = 0.1;
  double max_contradiction = 0.1;
  double joint_probability = 0.99;
  int confirmations = 2;
  double confirmation_distance = 2.0;

  void describe(auto& v) {
    v.value("enabled", enabled,
            {"",
             "Search the place in the old map where the robot comes back and association does not "
             "recognize the walls. Needs delayed poses and a front-end of laser scans."});
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
    v.value("max_contradiction", max_contradiction,
            {"1", "Largest share of the view where old beams went through.", 0, 1});
    v.value(
        "joint_probability", joint_probability,
        {"1", "Two matches agree if their misfit is below this chi-square probability.", 1e-6, 1});
    v.value("confirmations", confirmations,
            {"1", "Views from different places that must find the same correction.", 1, 100});
    v.value("confirmation_distance", confirmation_distance,
            {"m", "These places are at least so far apart on the way.", 0});
  }
};

}  // namespace libslam
