#pragma once
// Contract of front-ends: MRPT observations in, features out. A front-end never sees the filter.
//
// Given   a sensory frame of the log,
// Then    `extract` returns one batch of features per usable observation, in the order of the log;
//         unusable measurements (not finite, range not positive, noise not positive) are left out
//         and counted, never thrown.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <mrpt/obs/CSensoryFrame.h>

#include <libslam/data/feature.hpp>

namespace libslam {

/// Features of one observation: at most one of them belongs to any landmark.
using FeatureBatch = std::vector<Feature>;

class Frontend {
 public:
  virtual ~Frontend() = default;
  /// Overwrites `batches`.
  virtual void extract(const mrpt::obs::CSensoryFrame& frame,
                       std::vector<FeatureBatch>& batches) = 0;
  /// Where beams of the last frame that was extracted ended, in the frame of the robot [m]; empty
  /// without such a sensor.
  virtual std::span<const Eigen::Vector2d> surface_points() const { return {}; }
  /// False if a frame can be left out without harm to what is made of the others.
  virtual bool needs_every_frame() const { return true; }
  /// Measurements left out so far because they were unusable.
  virtual std::int64_t unusable() const = 0;
  /// One line for each of the first defects, and whatever else the user should know.
  virtual std::vector<std::string> warnings() const { return {}; }
  /// How well it works, by name, for run.json; empty if there is nothing to say.
  virtual std::map<std::string, double> figures() const { return {}; }
};

}  // namespace libslam
