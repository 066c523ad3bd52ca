#pragma once
// The map of the report: path, truth, landmarks and ellipses.

#include <optional>
#include <span>

#include <mrpt/math/TPose2D.h>
#include <nlohmann/json.hpp>

#include <libslam/result/report.hpp>

namespace libslam {

/// Six significant digits keep the page small and are finer than a pixel; null where not finite.
nlohmann::ordered_json short_number(double value);

/// `path`, `truth` {x, y}, `truth_is_sparse`, `pose_ellipses` [x, y, xx, xy, yy], `landmarks` (an
/// ellipse, id, times seen), `true_landmarks` [x, y, id], `ellipse_scale` (sigmas of a 95 %
/// ellipse). `placement` is T_truth_filter; without it the frame of the truth is unknown and the
/// truth stays out.
nlohmann::ordered_json make_map_data(const ReportInput& input, std::span<const EstimatedPose> path,
                                     const std::optional<mrpt::math::TPose2D>& placement);

}  // namespace libslam
