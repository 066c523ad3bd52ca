#pragma once
// The map of the report: path, truth, landmarks and ellipses.

#include <nlohmann/json.hpp>

#include <libslam/result/report.hpp>

namespace libslam {

/// Six significant digits keep the page small and are finer than a pixel; null where not finite.
nlohmann::ordered_json short_number(double value);

/// Adds `map`, seen from above, and of a run in space whose height varies `side` with z in the
/// place of y: `path`, `truth` {x, y}, `truth_is_sparse`, `pose_ellipses` [x, y, xx, xy, yy],
/// `landmarks` (an ellipse, id, times seen), `true_landmarks` [x, y, id], `events` [x, y, what] if
/// any, `ellipse_scale` (sigmas of a 95 % ellipse); in the plane `walls` [x, y, x, y, id, times
/// seen] of lines with an extent and `smoothed` {x, y}, if any. All in the frame of the truth;
/// without a placement in summary.truth that frame is unknown and the truth stays out.
void add_map_data(nlohmann::ordered_json& data, const ReportInput& input);

}  // namespace libslam
