#include <optional>

#include <libslam/pipeline/factory.hpp>
#include <libslam/pipeline/pipeline.hpp>

namespace libslam {

namespace {

InputParameters reader_input(InputParameters input) {
  if (input.odometry == "none") input.odometry = "increments";
  return input;
}

}  // namespace

Pipeline::Pipeline(const Parameters& parameters, const TrueState* truth)
    : odometry_(reader_input(parameters.input)),
      ignore_odometry_(parameters.input.odometry == "none"),
      frontend_(make_frontend(parameters)),
      schedule_(parameters.policies.update_period_s, parameters.policies.update_every_n),
      filter_(make_filter_parts(parameters, truth)) {}

StepRecord Pipeline::process(const LogStep& step) {
  std::optional<MotionAction> action;
  if (step.action && !ignore_odometry_) action = odometry_.read(step);
  if (step.action) propagate(action ? &*action : nullptr);
  return update(step);
}

StepRecord Pipeline::process_frame(const LogStep& step) {
  propagate(nullptr);
  return update(step);
}

void Pipeline::propagate(const MotionAction* action) {
  filter_.propagate(action);
  if (observer_ != nullptr) observer_->on_motion(action);
}

StepRecord Pipeline::update(const LogStep& step) {
  last_update_ = {};
  if (step.frame) {
    {
      const PhaseTimer timer(filter_.times(), Phase::kExtract);
      frontend_->extract(*step.frame, batches_);
    }
    if (!batches_.empty() && schedule_.due(step.time))
      for (const FeatureBatch& batch : batches_) {
        const UpdateOutcome outcome = filter_.update(batch);
        if (observer_ != nullptr) observer_->on_update(batch, outcome);
        last_update_ += outcome;
      }
  }
  StepRecord record;
  record.index = step.index;
  record.time = step.time;
  record.pose = filter_.state().estimate(filter_.pose());
  record.cov = filter_.state().covariance_of(filter_.pose());
  record.nis = last_update_.nis;
  record.nis_dof = last_update_.nis_dof;
  record.accepted = last_update_.accepted;
  record.gated = last_update_.gated;
  record.ambiguous = last_update_.ambiguous;
  record.new_landmarks = last_update_.new_landmarks;
  record.event = last_update_.event;
  record.calibration = filter_.calibration();
  record.noise = filter_.noise();
  return record;
}

}  // namespace libslam
