#pragma once
// What a run is plotted over and divided by.

#include <cstdint>
#include <span>

#include <libslam/result/trajectory.hpp>

namespace libslam {

/// Log time since the first step [s] where the log has usable times, else the number of the step.
/// Times are usable where at least nine of ten rows are later than the row before: simulators have
/// left logs in which all times are equal or fall into a few values.
class RunAxis {
 public:
  explicit RunAxis(std::span<const EstimatedPose> path);

  bool is_time() const { return is_time_; }
  double at(std::int64_t step, double time) const {
    return is_time_ ? time - start_ : static_cast<double>(step);
  }
  double at(const EstimatedPose& pose) const { return at(pose.step, pose.time); }
  /// Of a step of the path, or of the row before it where the step has no row. The path must not be
  /// empty.
  double at_step(std::int64_t step) const;

 private:
  std::span<const EstimatedPose> path_;
  bool is_time_ = false;
  double start_ = 0.0;
};

}  // namespace libslam
