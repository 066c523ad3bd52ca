#pragma once
// A run repeated, with its data kept.

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <libslam/batch/batch_log.hpp>
#include <libslam/config/parameters.hpp>
#include <libslam/map/landmark_map.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam {

struct FilterReplay {
  BatchLog log;
  BatchEstimate estimate;           ///< the filter's: its path as it was on line
  std::vector<EstimatedPose> path;  ///< the same path with covariances
  LandmarkMap map;                  ///< confirmed landmarks at the end
  std::vector<CalibrationValue> calibration;
};

/// Plays `rawlog` through the filter of `parameters`, as `run_rawlog` does, for at most `max_steps`
/// steps. Throws InputError where the log cannot be read, std::invalid_argument where the log lacks
/// a field that the configuration asks for, or the configuration has no landmarks or
/// starts in a map, which would be a prior that the batch does not have.
FilterReplay replay_filter(const std::string& rawlog, const Parameters& parameters,
                           std::int64_t max_steps = std::numeric_limits<std::int64_t>::max());

}  // namespace libslam
