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
/// last sighting is composed with the covariance of our motion model: the class accepts no motion
/// without an observation. It has no calibration: the model takes the prior means as constants. And
/// it drops the motion before its first landmark, so that its path starts there.
class MrptFilter {
 public:
  /// The default updates P by (I - K H) P, which does not keep it symmetric; Davison's updates one
  /// measurement after the other and does not recompute the innovations.
  enum class Method { kDefault, kDavison };

  /// `parameters` must be valid.
  explicit MrptFilter(const Parameters& parameters, Method method = Method::kDefault);
  ~MrptFilter();
  MrptFilter(const MrptFilter&) = delete;
  MrptFilter& operator=(const MrptFilter&) = delete;

  /// Pose and covariance at an observation: after the update, or, without usable sightings,
  /// predicted by the motion since the last one. Nothing for a step without frame. Throws what MRPT
  /// throws.
  std::optional<StepRecord> process(const LogStep& step);
  LandmarkMap landmarks() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace libslam
