#pragma once
// One step of a log through all parts: odometry -> filter <- association <- features.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <libslam/config/parameters.hpp>
#include <libslam/data/log_step.hpp>
#include <libslam/data/step_record.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/frontend/frontend.hpp>
#include <libslam/frontend/odometry.hpp>
#include <libslam/pipeline/matched_odometry.hpp>
#include <libslam/policy/update_schedule.hpp>

namespace libslam {

/// Sees what the filter was given and what it made of it.
class FilterObserver {
 public:
  virtual ~FilterObserver() = default;
  /// The filter has moved; null: by a step without odometry.
  virtual void on_motion(const MotionAction* action) = 0;
  /// The filter has taken in the features of one observation.
  virtual void on_update(std::span<const Feature> features, const UpdateOutcome& outcome) = 0;
};

/// Where a filter starts, if not where the parameters say.
struct FilterStart {
  std::optional<MapStart> map;  ///< a map in memory instead of map.file
  BlockVector pose;  ///< storage of the motion model's pose; empty: as the parameters say
  BlockMatrix cov;   ///< of its error, tangent coordinates; goes with `pose`
};

class Pipeline {
 public:
  /// `parameters` must be valid (config/validation.hpp); throws std::invalid_argument otherwise,
  /// and if the map to start in does not fit. `truth`: see make_filter_parts.
  explicit Pipeline(const Parameters& parameters, const TrueState* truth = nullptr,
                    FilterStart start = {});

  /// Moves by the odometry of the step and updates with its frame if one is due. Throws
  /// UnusableOdometry (frontend/odometry.hpp) before anything has changed, and
  /// std::invalid_argument if the odometry lacks a field that the configuration asks for.
  StepRecord process(const LogStep& step);
  /// The same without the odometry of the step: for steps whose odometry is unusable.
  StepRecord process_frame(const LogStep& step);

  /// Localization from now on, or SLAM: EkfSlam::give_landmarks.
  void give_landmarks(bool given) { filter_.give_landmarks(given); }
  /// False if the motion model knows by itself how the body moves between two frames.
  bool needs_odometry() const { return !keeps_velocity_; }
  /// The pose and the calibration as they are now, without anything about an update.
  StepRecord estimate() const;

  /// `observer` must outlive its use here; null: none.
  void observe(FilterObserver* observer) { observer_ = observer; }

  const EkfSlam& filter() const { return filter_; }
  const Frontend& frontend() const { return *frontend_; }
  const UpdateSchedule& schedule() const { return schedule_; }
  const OdometryReader& odometry() const { return odometry_; }
  /// Null unless `input.scan_matching` is enabled.
  const MatchedOdometry* matched_odometry() const { return matched_ ? &*matched_ : nullptr; }
  /// What the last frame did to the filter; empty if it was not due.
  const UpdateOutcome& last_update() const { return last_update_; }
  /// What the front-end made of the last frame, due or not.
  std::span<const FeatureBatch> last_features() const { return batches_; }

 private:
  void propagate(const MotionAction* action);
  /// The motion of a body that keeps its velocity until `time`.
  MotionAction keep_velocity(double time);
  /// Fills the batches, unless the frame cannot be due.
  void extract(const LogStep& step);
  StepRecord update(const LogStep& step);
  Eigen::Vector3d planar_pose() const;

  OdometryReader odometry_;
  std::optional<MatchedOdometry> matched_;
  bool ignore_odometry_, keeps_velocity_;
  std::unique_ptr<Frontend> frontend_;
  UpdateSchedule schedule_;
  EkfSlam filter_;
  FilterObserver* observer_ = nullptr;
  UpdateOutcome last_update_;
  std::optional<double> time_;  // of the step before, for motion without odometry
  std::vector<FeatureBatch> batches_;
};

}  // namespace libslam
