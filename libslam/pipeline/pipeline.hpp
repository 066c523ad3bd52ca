#pragma once
// One step of a log through all parts: odometry -> filter <- association <- features.

#include <memory>
#include <vector>

#include <libslam/config/parameters.hpp>
#include <libslam/data/log_step.hpp>
#include <libslam/data/step_record.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/frontend/frontend.hpp>
#include <libslam/frontend/odometry.hpp>
#include <libslam/policy/update_schedule.hpp>

namespace libslam {

class Pipeline {
 public:
  /// `parameters` must be valid (config/validation.hpp); throws std::invalid_argument otherwise.
  explicit Pipeline(const Parameters& parameters);

  /// Moves by the odometry of the step and updates with its frame if one is due. Throws
  /// UnusableOdometry (frontend/odometry.hpp) before anything has changed, and
  /// std::invalid_argument if the odometry lacks a field that the configuration asks for.
  StepRecord process(const LogStep& step);
  /// The same without the odometry of the step: for steps whose odometry is unusable.
  StepRecord process_frame(const LogStep& step);

  const EkfSlam& filter() const { return filter_; }
  const Frontend& frontend() const { return *frontend_; }
  const OdometryReader& odometry() const { return odometry_; }
  /// What the last frame did to the filter; empty if it was not due.
  const UpdateOutcome& last_update() const { return last_update_; }

 private:
  StepRecord update(const LogStep& step);

  OdometryReader odometry_;
  bool ignore_odometry_;
  std::unique_ptr<Frontend> frontend_;
  UpdateSchedule schedule_;
  EkfSlam filter_;
  UpdateOutcome last_update_;
  std::vector<FeatureBatch> batches_;
};

}  // namespace libslam
