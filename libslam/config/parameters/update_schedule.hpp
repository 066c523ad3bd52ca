#pragma once
// When a frame may update the filter.

#include <string>

#include <libslam/config/description.hpp>

namespace libslam {

/// Section `policies.update_schedule`.
struct UpdateScheduleParameters {
  double per_feature = 0.0;
  std::string form = "relative";
  double distance = 0.0;
  double turn_deg = 0.0;

  void describe(auto& v) {
    v.value("per_feature", per_feature,
            {"1 | s",
             "Stretches the time to the next update for every feature of the last one, since what "
             "is seen bounds the error (mu of S2.16); 0: not at all.",
             0});
    v.value("form", form,
            {"",
             "relative: T = update_period_s (1 + per_feature s) with s features; absolute: T = "
             "update_period_s + per_feature s.",
             0,
             0,
             {"relative", "absolute"}});
    v.value(
        "distance", distance,
        {"m", "Next update after so long a way, or after turn_deg; 0: the way does not count.", 0});
    v.value("turn_deg", turn_deg,
            {"deg", "Next update after such a turn, or after distance; 0: the turn does not count.",
             0});
  }
};

}  // namespace libslam
