#pragma once
// Time plots of a run against its truth.

#include <nlohmann/json.hpp>

#include <libslam/result/report.hpp>
#include <libslam/result/run_axis.hpp>

namespace libslam {

/// Appends the plots of the pose error with its sigmas, in the filter's frame, and of NEES; nothing
/// without a placement in summary.truth.
void add_error_plots(nlohmann::ordered_json& plots, const ReportInput& in, const RunAxis& axis);

}  // namespace libslam
