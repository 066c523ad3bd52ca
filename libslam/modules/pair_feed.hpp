#pragma once
// The pairs that an MRPT program hands to a module, on their way through a pipeline; not for users.

#include <cstdint>
#include <string>

#include <mrpt/system/COutputLogger.h>

#include <libslam/data/step_record.hpp>
#include <libslam/io/intake.hpp>
#include <libslam/io/pair_assembler.hpp>
#include <libslam/modules/module_state.hpp>
#include <libslam/pipeline/pipeline.hpp>

namespace libslam {

class PairFeed {
 public:
  /// `entry_point`: what warnings call the source of the pairs.
  PairFeed(const Parameters& parameters, const std::string& entry_point, FilterStart start = {});
  /// Goes on where state() was taken.
  PairFeed(const Parameters& parameters, const std::string& entry_point, ModuleState state);
  PairFeed(const PairFeed&) = delete;  // its parts refer to each other

  /// The landmarks are given by the map that the parameters name.
  static bool localizes(const Parameters& parameters);

  /// One step: odometry of `action`, if it has any, then what `frame` shows. Either may be null.
  /// Once there is a map, a step without odometry may have moved the robot unseen. Throws
  /// UnusableOdometry for a movement in space of a planar robot, with the state unchanged, and
  /// InputError at a defect if input.policy is strict.
  const StepRecord& process(const mrpt::obs::CActionCollection::Ptr& action,
                            const mrpt::obs::CSensoryFrame::Ptr& frame);
  /// A step that has its time already.
  const StepRecord& process(LogStep step);
  /// The last step again, without its odometry: after UnusableOdometry.
  const StepRecord& process_without_odometry();

  /// What the last step left behind; before the first one where the filter starts.
  const StepRecord& last() const { return last_; }
  /// Steps so far.
  std::int64_t steps() const { return steps_; }
  const Pipeline& pipeline() const { return pipeline_; }
  const EkfSlam& filter() const { return pipeline_.filter(); }
  ModuleState state() const { return {filter().saved_map(), steps_, assembler_.clock()}; }
  /// Localization from now on, or SLAM: EkfSlam::give_landmarks.
  void give_landmarks(bool given) { pipeline_.give_landmarks(given); }
  /// Tells `logger` what became of the last step (debug), what happened to the filter, and new
  /// findings about the input (warnings).
  void report(mrpt::system::COutputLogger& logger);

 private:
  /// The pair with a time that can be trusted; both null: an empty step.
  LogStep assemble(const mrpt::obs::CActionCollection::Ptr& action,
                   const mrpt::obs::CSensoryFrame::Ptr& frame);

  Intake intake_;
  PairAssembler assembler_;
  Pipeline pipeline_;
  LogStep step_;  // the last one
  StepRecord last_;
  std::int64_t steps_ = 0;
  std::size_t warnings_logged_ = 0;
  bool healthy_ = true;
};

}  // namespace libslam
