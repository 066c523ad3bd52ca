#pragma once
// Rawlogs in memory, so that only the filters are timed.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/log_step.hpp>

namespace libslam::bench {

/// The steps of a log that have both an action and a frame: what MRPT's class can take.
using PreloadedLog = std::vector<LogStep>;

/// MRPT's packaged range-bearing demo.
const PreloadedLog& kf_slam_demo();

/// Victoria Park in the relative form of iSAM, imported into a directory that is removed; nothing
/// if the data set is not under $LIBSLAM_DATA (default: ../shared/data beside the checkout). Every
/// observation states the largest range of the log as the range of its sensor, because MRPT
/// predicts what lies within.
const std::optional<PreloadedLog>& victoria_park();

/// Root mean square of the sigmas that the observations of a log state, range [m] and bearing
/// [rad].
Eigen::Vector2d mean_sigmas(const PreloadedLog& log);

}  // namespace libslam::bench
