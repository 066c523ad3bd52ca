#pragma once
// MRPT's own range-bearing EKF-SLAM, fed with the steps of a log: what results are compared with.

#include <memory>
#include <optional>

#include <libslam/config/parameters.hpp>
#include <libslam/data/log_step.hpp>
#include <libslam/data/step_record.hpp>
#include <libslam/map/landmark_map.hpp>

namespace libslam {

/// `CRangeBearingKFSLAM2D` with the sensor noise and gate of a configuration. The motion since the
/// last sighting is composed with the covariance of our nominal motion model: the class accepts no
/// motion without an observation, and has no calibration.
class MrptFilter {
 public:
  /// `parameters` must be valid; its calibration is ignored.
  explicit MrptFilter(const Parameters& parameters);
  ~MrptFilter();
  MrptFilter(const MrptFilter&) = delete;
  MrptFilter& operator=(const MrptFilter&) = delete;

  /// Pose and covariance after an update; nothing for a step without usable sightings.
  /// Throws what MRPT throws.
  std::optional<StepRecord> process(const LogStep& step);
  LandmarkMap landmarks() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace libslam
