#include <optional>
#include <utility>

#include <libslam/data/step_events.hpp>
#include <libslam/pipeline/factory.hpp>
#include <libslam/pipeline/pipeline.hpp>

namespace libslam {

namespace {

InputParameters reader_input(InputParameters input) {
  if (input.odometry == "none") input.odometry = "increments";
  return input;
}

EkfSlamParts make_parts(const Parameters& parameters, const TrueState* truth, FilterStart start) {
  EkfSlamParts parts = make_filter_parts(parameters, truth);
  if (start.map) parts.map = std::move(start.map);
  if (start.pose.size() > 0) {
    parts.start = start.pose;
    parts.cov_start = start.cov;
  }
  return parts;
}

int count_features(std::span<const FeatureBatch> batches) {
  std::size_t count = 0;
  for (const FeatureBatch& batch : batches) count += batch.size();
  return static_cast<int>(count);
}

void fill_pose(const GaussianState& state, BlockId pose, StepRecord& record) {
  const auto x = state.estimate(pose);
  if (state.spec(pose).chart == Chart::kSE2) {
    record.pose = x;
    record.cov = state.covariance_of(pose);
    return;
  }
  record.spatial.emplace();
  record.spatial->pose = {x.head<3>(), Eigen::Quaterniond(x[6], x[3], x[4], x[5])};
  record.spatial->cov = state.covariance_of(pose);
  record.pose = shadow_of(record.spatial->pose);
  record.cov = shadow_covariance(*record.spatial);
}

}  // namespace

Pipeline::Pipeline(const Parameters& parameters, const TrueState* truth, FilterStart start)
    : odometry_(reader_input(parameters.input)),
      ignore_odometry_(parameters.input.odometry == "none"),
      keeps_velocity_(parameters.motion.model == "constant_twist"),
      frontend_(make_frontend(parameters)),
      schedule_(parameters.policies),
      filter_(make_parts(parameters, truth, std::move(start))) {
  if (parameters.input.scan_matching.enabled) matched_.emplace(parameters);
}

StepRecord Pipeline::process(const LogStep& step) {
  const bool moves = step.action || step.twist || keeps_velocity_;
  std::optional<MotionAction> action;
  if (keeps_velocity_)
    action = keep_velocity(step.time);
  else if (moves && !ignore_odometry_)
    action = odometry_.read(step);
  if (matched_ && action) matched_->refine(step, *action);
  if (moves) propagate(action ? &*action : nullptr);
  return update(step);
}

StepRecord Pipeline::process_frame(const LogStep& step) {
  if (matched_) matched_->restart();
  propagate(nullptr);
  return update(step);
}

MotionAction Pipeline::keep_velocity(double time) {
  MotionAction action;
  action.time = time;
  action.dt = time_ ? time - *time_ : 0.0;
  time_ = time;
  return action;
}

void Pipeline::propagate(const MotionAction* action) {
  filter_.propagate(action);
  if (observer_ != nullptr) observer_->on_motion(action);
}

Eigen::Vector3d Pipeline::planar_pose() const {
  const auto x = filter_.state().estimate(filter_.pose());
  if (x.size() == 3) return x;
  return shadow_of({x.head<3>(), Eigen::Quaterniond(x[6], x[3], x[4], x[5])});
}

void Pipeline::extract(const LogStep& step) {
  const PhaseTimer timer(filter_.times(), Phase::kExtract);
  batches_.clear();
  if (frontend_->needs_every_frame() || !schedule_.skip(step.time, planar_pose()))
    frontend_->extract(*step.frame, batches_);
}

StepRecord Pipeline::update(const LogStep& step) {
  last_update_ = {};
  bool updated = false;
  if (step.frame) {
    extract(step);
    if (!batches_.empty() && schedule_.due(step.time, planar_pose(), count_features(batches_)))
      for (const FeatureBatch& batch : batches_) {
        const UpdateOutcome outcome = filter_.update(batch);
        if (observer_ != nullptr) observer_->on_update(batch, outcome);
        last_update_ += outcome;
        updated = true;
      }
  }
  filter_.remember_pose(step.time);
  if (updated && filter_.look_for_loops(frontend_->surface_points()))
    add_events(last_update_.event, "loop_closed");
  StepRecord record = estimate();
  record.index = step.index;
  record.time = step.time;
  record.nis = last_update_.nis;
  record.nis_dof = last_update_.nis_dof;
  record.accepted = last_update_.accepted;
  record.gated = last_update_.gated;
  record.ambiguous = last_update_.ambiguous;
  record.new_landmarks = last_update_.new_landmarks;
  record.event = last_update_.event;
  return record;
}

StepRecord Pipeline::estimate() const {
  StepRecord record;
  fill_pose(filter_.state(), filter_.pose(), record);
  record.calibration = filter_.calibration();
  record.noise = filter_.noise();
  return record;
}

}  // namespace libslam
