#include <memory>
#include <string>
#include <utility>

#include <libslam/modules/pair_feed.hpp>

namespace libslam {

namespace {

FilterStart start_in(SavedMap map) {
  FilterStart start;
  start.map.emplace().map = std::make_shared<const SavedMap>(std::move(map));
  return start;
}

/// The map is in the state already.
Parameters without_map_file(Parameters parameters) {
  parameters.map.file.clear();
  return parameters;
}

}  // namespace

bool PairFeed::localizes(const Parameters& parameters) {
  return !parameters.map.file.empty() && parameters.map.mode == "localize";
}

PairFeed::PairFeed(const Parameters& parameters, const std::string& entry_point, FilterStart start)
    : intake_(entry_point, parameters.input.policy),
      assembler_(intake_),
      pipeline_(parameters, nullptr, std::move(start)),
      last_(pipeline_.estimate()) {}

PairFeed::PairFeed(const Parameters& parameters, const std::string& entry_point, ModuleState state)
    : PairFeed(without_map_file(parameters), entry_point, start_in(std::move(state.map))) {
  if (localizes(parameters)) give_landmarks(true);
  steps_ = state.steps;
  assembler_.set_clock(state.clock);
}

const StepRecord& PairFeed::process(const mrpt::obs::CActionCollection::Ptr& action,
                                    const mrpt::obs::CSensoryFrame::Ptr& frame) {
  return process(assemble(action, frame));
}

const StepRecord& PairFeed::process(LogStep step) {
  step_ = std::move(step);
  step_.index = steps_++;
  const bool may_have_moved =
      !step_.action && pipeline_.needs_odometry() && filter().registry().size() > 0;
  last_ = may_have_moved ? pipeline_.process_frame(step_) : pipeline_.process(step_);
  return last_;
}

const StepRecord& PairFeed::process_without_odometry() {
  return last_ = pipeline_.process_frame(step_);
}

LogStep PairFeed::assemble(const mrpt::obs::CActionCollection::Ptr& action,
                           const mrpt::obs::CSensoryFrame::Ptr& frame) {
  if (action) assembler_.add_action(action, steps_);
  if (frame)
    assembler_.add_frame(frame, steps_);
  else
    assembler_.finish();
  LogStep step;
  if (!assembler_.ready().empty()) step = std::move(assembler_.ready().front());
  assembler_.ready().clear();
  return step;
}

void PairFeed::report(mrpt::system::COutputLogger& logger) {
  using namespace mrpt::system;  // the names of the levels
  const std::string pair = "pair " + std::to_string(steps_);
  logger.logStr(LVL_DEBUG, pair + ": " + std::to_string(last_.accepted) + " sightings, " +
                               std::to_string(last_.new_landmarks) + " new landmarks, " +
                               std::to_string(last_.gated + last_.ambiguous) + " not used");
  if (!last_.event.empty()) logger.logStr(LVL_WARN, pair + ": " + last_.event);
  const auto& warnings = intake_.summary().warnings;
  while (warnings_logged_ < warnings.size()) logger.logStr(LVL_WARN, warnings[warnings_logged_++]);
  if (std::exchange(healthy_, filter().healthy()) && !healthy_)
    logger.logStr(LVL_ERROR, "the filter diverged at " + pair);
}

}  // namespace libslam
