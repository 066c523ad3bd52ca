#pragma once
// Time plots of what the filter says about itself.

#include <nlohmann/json.hpp>

#include <libslam/result/report.hpp>
#include <libslam/result/run_axis.hpp>

namespace libslam {

/// Appends the plots of innovations, calibration and adapted noise, as far as the run has them,
/// read from its trajectory.csv: only their envelopes are kept in memory. Throws like
/// TrajectoryReader.
void add_filter_plots(nlohmann::ordered_json& plots, const ReportInput& in, const RunAxis& axis);

}  // namespace libslam
