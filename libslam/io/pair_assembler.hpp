#pragma once
// Logs of (action, frame) pairs: each pair becomes one step, with a time that can be trusted.

#include <cstdint>
#include <deque>
#include <optional>

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <libslam/data/log_step.hpp>
#include <libslam/io/intake.hpp>

namespace libslam {

/// Turns the entries of a pair log into steps.
///
/// A frame without an action before it (the leading frame of many logs) becomes a step with a null
/// action, an action without a frame after it a step with a null frame. The time of a step is that
/// of its first observation with a valid stamp, else that of the action, else the time of the step
/// before; it never goes backwards, because here the order of the log, not the clock, carries the
/// motion. `dt` is given only where both ends of the motion have a valid stamp. Motions that are
/// not finite, null objects and flags with garbage in them (old logs) are handled as `intake` says.
class PairAssembler {
 public:
  explicit PairAssembler(Intake& intake) : intake_(intake) {}

  void add_action(const mrpt::obs::CActionCollection::Ptr& action, std::int64_t entry);
  void add_frame(const mrpt::obs::CSensoryFrame::Ptr& frame, std::int64_t entry);
  /// Releases an action that still waits for its frame.
  void finish();

  /// Steps that are complete; `index` is not set.
  std::deque<LogStep>& ready() { return ready_; }

  /// What the times of further steps go on from.
  struct Clock {
    bool any_step = false;
    double time = 0.0;                  ///< of the last step
    std::optional<double> motion_time;  ///< of the last step that had a valid one
  };
  const Clock& clock() const { return clock_; }
  void set_clock(const Clock& clock) { clock_ = clock; }

 private:
  void emit(const mrpt::obs::CSensoryFrame::Ptr& frame, std::int64_t entry);
  double place(std::optional<double> stamp, std::int64_t entry);

  Intake& intake_;
  mrpt::obs::CActionCollection::Ptr waiting_;
  std::int64_t waiting_entry_ = 0;
  Clock clock_;
  std::deque<LogStep> ready_;
};

}  // namespace libslam
