#include <algorithm>
#include <stdexcept>
#include <string>

#include <libslam/data/step_events.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/filter/pair_test.hpp>

namespace libslam {

namespace {

EkfSlamParts checked(EkfSlamParts parts) {
  if (!parts.motion || !parts.frame)
    throw std::invalid_argument("EkfSlam needs a motion model and an error frame");
  if (!parts.displacement && (!parts.measurement || !parts.associator))
    throw std::invalid_argument(
        "EkfSlam needs a measurement model and an associator, or a displacement model");
  if (parts.displacement && parts.disturbance)
    throw std::invalid_argument("EkfSlam notices disturbances by landmarks alone");
  if (parts.displacement && parts.linearization)
    throw std::invalid_argument("EkfSlam linearizes displacements at the estimate");
  if (parts.map && (parts.displacement || parts.linearization))
    throw std::invalid_argument(
        "EkfSlam starts in a map with a measurement model of landmarks, linearized at the "
        "estimate");
  if (parts.disturbance && parts.disturbance->relocalizes() &&
      (parts.motion->pose_spec().chart != Chart::kSE2 ||
       tangent_dimension(parts.measurement->landmark_spec()) != 2))
    throw std::invalid_argument(
        "EkfSlam finds a lost pose again in the plane alone, among planar landmarks");
  return parts;
}

BlockVector origin_of(const BlockSpec& pose) {
  BlockVector origin = BlockVector::Zero(storage_dimension(pose));
  if (pose.chart == Chart::kSE3) origin[6] = 1.0;
  return origin;
}

}  // namespace

UpdateOutcome& UpdateOutcome::operator+=(const UpdateOutcome& other) {
  nis += other.nis;
  nis_dof += other.nis_dof;
  accepted += other.accepted;
  gated += other.gated;
  ambiguous += other.ambiguous;
  new_landmarks += other.new_landmarks;
  add_events(event, other.event);
  verdicts.insert(verdicts.end(), other.verdicts.begin(), other.verdicts.end());
  return *this;
}

EkfSlam::EkfSlam(EkfSlamParts parts)
    : parts_(checked(std::move(parts))),
      ekf_(std::move(parts_.frame)),
      linearizer_(std::move(parts_.linearization)),
      calibration_(*parts_.motion, displacement_model()) {
  if (parts_.measurement) {
    ekf_.frame().require_supported(parts_.measurement->landmark_spec());
    linearizer_.require_supported(parts_.measurement->landmark_spec());
  }
  const BlockSpec pose = parts_.motion->pose_spec();
  ekf_.frame().require_supported(pose);
  pose_ =
      state_.add(pose, parts_.start.size() > 0 ? parts_.start : origin_of(pose), parts_.cov_start);
  linearizer_.add_block(state_, pose_);
  calibration_.add_to(state_, linearizer_);
  if (parts_.building_prior) parts_.building_prior->add_to(state_);
  if (parts_.map) start_in_map();
}

void EkfSlam::start_in_map() {
  enter_map(*parts_.map,
            {state_, pose_, calibration_, parts_.registry, parts_.measurement->landmark_spec()});
  give_landmarks(parts_.map->landmarks_given);
  parts_.map.reset();
}

void EkfSlam::give_landmarks(bool given) {
  landmarks_given_ = given;
  considered_.clear();
  if (given)
    for (const RegisteredLandmark& landmark : parts_.registry.landmarks())
      if (!state_.is_constant(landmark.block)) considered_.push_back(landmark.block);
  given_ = considered_.size();
}

SavedMap EkfSlam::saved_map() const {
  if (!parts_.measurement) throw std::invalid_argument("a filter of displacements has no map");
  return leave_map(state_, pose_, calibration_, parts_.registry,
                   parts_.measurement->landmark_spec());
}

std::span<const BlockId> EkfSlam::considered() {
  const std::span<const BlockId> calibration =
      disturbed() ? std::span<const BlockId>(calibration_.all()) : calibration_.considered();
  if (given_ == 0) return calibration;
  considered_.resize(given_);
  considered_.insert(considered_.end(), calibration.begin(), calibration.end());
  return considered_;
}

const DisplacementModel* EkfSlam::displacement_model() const {
  return parts_.displacement ? &parts_.displacement->model() : nullptr;
}

void EkfSlam::propagate(const MotionAction* action) {
  const PhaseTimer timer(times_, Phase::kPredict);
  if (action == nullptr) {
    state_.covariance().add_noise(state_.offset(pose_), parts_.cov_no_odometry);
    if (parts_.implied_input)
      parts_.implied_input->move(BlockMatrix::Identity(state_.size(pose_), state_.size(pose_)),
                                 parts_.cov_no_odometry);
    linearizer_.stood(state_, pose_);
    return;
  }
  linearizer_.linearize(*parts_.motion, state_, pose_, calibration_.of_motion(), *action, step_);
  if (parts_.process) scale_process_noise();
  if (!calibration_.empty())
    calibration_.observe(state_, pose_, step_, action->dt, displacement_model());
  if (parts_.disturbance)
    parts_.disturbance->moved(state_.estimate(pose_), step_.estimate, step_.cov_noise);
  ekf_.propagate(state_, step_);
  if (parts_.implied_input)
    parts_.implied_input->move(step_.wrt.begin()->jacobian, step_.cov_noise);
  linearizer_.moved(state_, pose_);
  calibration_.diffuse(state_, action->dt);
}

void EkfSlam::scale_process_noise() {
  for (const BlockJacobian& column : step_.wrt)
    if (column.block == pose_) parts_.process->scale(column.jacobian, step_.cov_noise);
}

void EkfSlam::learn_process_noise() {
  if (disturbed())
    parts_.process->skip();
  else
    parts_.process->observe(ekf_.look_back(accepted(), pose_, state_.size(pose_)));
}

UpdateOutcome EkfSlam::measure_displacement(const Feature& reading) {
  const PhaseTimer timer(times_, Phase::kUpdate);
  const DisplacementOutcome done = parts_.displacement->apply(
      state_, ekf_, pose_, calibration_.of_sensor(), calibration_.considered(), reading);
  UpdateOutcome outcome;
  outcome.nis = done.correction.nis;
  outcome.nis_dof = done.correction.dof;
  outcome.accepted = done.correction.applied ? 1 : 0;
  outcome.gated = done.measured && !done.correction.applied ? 1 : 0;
  return outcome;
}

UpdateOutcome EkfSlam::update(std::span<const Feature> features) {
  UpdateOutcome outcome;
  if (parts_.displacement) {
    for (const Feature& reading : features) outcome += measure_displacement(reading);
    return outcome;
  }
  if (parts_.noise) {
    adapted_.assign(features.begin(), features.end());
    parts_.noise->apply(adapted_);
    features = adapted_;
  }
  associate(features);
  if (parts_.disturbance) respond(features, outcome);
  if (parts_.implied_input) reject_impossible(features, outcome);
  if (parts_.disturbance && !used_.empty()) parts_.disturbance->open(state_, pose_);
  correct(features, outcome);
  if (parts_.disturbance && outcome.accepted > 0) reconsider(outcome);
  add_landmarks(features, outcome);
  keep_up();
  return outcome;
}

AssociatedObservation EkfSlam::associate(std::span<const Feature> features) {
  const PhaseTimer timer(times_, Phase::kAssociate);
  PairTest test({state_, pose_, ekf_, linearizer_, *parts_.measurement, parts_.registry,
                 selected_pairs_, parts_.extent_gap},
                features);
  parts_.associator->associate(features, parts_.registry, test, verdicts_);
  if (landmarks_given_)
    for (Verdict& verdict : verdicts_)
      if (verdict.outcome == Outcome::kNew) verdict.outcome = Outcome::kAmbiguous;
  linearize_pairs(features);
  return {features, verdicts_, accepted(), measured_};
}

void EkfSlam::linearize_pairs(std::span<const Feature> features) {
  measured_.clear();
  measured_.reserve(features.size());
  used_.clear();
  const auto linearize = [&](Outcome outcome) {
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (verdicts_[i].outcome != outcome) continue;
      const BlockId landmark = parts_.registry.landmarks()[verdicts_[i].landmark].block;
      linearizer_.linearize(*parts_.measurement, state_, pose_, landmark, features[i],
                            measured_.emplace_back());
      if (!measured_.back().innovation.allFinite()) {  // out of sight
        verdicts_[i].outcome = Outcome::kGated;
        measured_.pop_back();
      } else if (outcome == Outcome::kPaired) {
        used_.push_back(i);
      }
    }
  };
  linearize(Outcome::kPaired);
  if (parts_.disturbance || parts_.implied_input) linearize(Outcome::kGated);
}

bool EkfSlam::weigh() {
  if (!ekf_.weigh(state_, accepted())) return false;
  if (!parts_.noise || disturbed()) return true;
  for (;;) {
    ekf_.look_back(accepted(), postfits_);
    for (std::size_t i = 0; i < used_.size(); ++i) postfits_[i].feature = used_[i];
    if (!parts_.noise->observe(adapted_, postfits_)) return true;
    for (std::size_t i = 0; i < used_.size(); ++i) measured_[i].cov = adapted_[used_[i]].cov;
    if (!ekf_.weigh(state_, accepted())) return false;
  }
}

Correction EkfSlam::correct_with_pairs(std::span<const Feature> features) {
  if (used_.empty() || !weigh()) return {};
  if (parts_.iteration)
    return parts_.iteration->correct(
        state_, ekf_, pose_, std::span(measured_).first(used_.size()), considered(),
        [&](std::size_t i, LinearizedMeasurement& measurement) {
          const BlockId landmark = parts_.registry.landmarks()[verdicts_[used_[i]].landmark].block;
          linearizer_.linearize(*parts_.measurement, state_, pose_, landmark, features[used_[i]],
                                measurement);
        });
  const Correction correction = ekf_.solve(state_, considered());
  ekf_.apply(state_, pose_);
  return correction;
}

void EkfSlam::correct(std::span<const Feature> features, UpdateOutcome& outcome) {
  const PhaseTimer timer(times_, Phase::kUpdate);
  const Eigen::Vector2d before = state_.estimate(pose_).head<2>();
  const Correction correction = correct_with_pairs(features);
  if (correction.applied) {
    linearizer_.corrected(state_, pose_, before);
    outcome.accepted = static_cast<int>(used_.size());
    outcome.nis = correction.nis;
    outcome.nis_dof = correction.dof;
    if (parts_.process) learn_process_noise();
  } else {
    // An innovation covariance that is not positive definite: nothing was used.
    for (Verdict& verdict : verdicts_)
      if (verdict.outcome == Outcome::kPaired) verdict.outcome = Outcome::kGated;
  }
  for (const Verdict& verdict : verdicts_) {
    if (verdict.outcome == Outcome::kGated) ++outcome.gated;
    if (verdict.outcome == Outcome::kAmbiguous) ++outcome.ambiguous;
  }
}

void EkfSlam::add_landmarks(std::span<const Feature> features, UpdateOutcome& outcome) {
  const PhaseTimer timer(times_, Phase::kAugment);
  for (std::size_t i = 0; i < features.size(); ++i)
    if (verdicts_[i].outcome == Outcome::kPaired)
      parts_.registry.record_sighting(
          verdicts_[i].landmark, features[i].appearance,
          sighted_part(parts_.registry.landmarks()[verdicts_[i].landmark].block, features[i]));
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (verdicts_[i].outcome != Outcome::kNew) continue;
    if (!parts_.measurement->initializable(features[i])) {
      verdicts_[i].outcome = Outcome::kAmbiguous;
      ++outcome.ambiguous;
      continue;
    }
    linearizer_.initialize(*parts_.measurement, state_, pose_, features[i], initialization_);
    const BlockId block = state_.augment(parts_.measurement->landmark_spec(), initialization_);
    linearizer_.added(state_, pose_, block, features[i].id);
    verdicts_[i].landmark = parts_.registry.size();
    parts_.registry.add(block, features[i].id, features[i].appearance,
                        sighted_part(block, features[i]));
    ++outcome.new_landmarks;
  }
  outcome.verdicts = verdicts_;
  const std::vector<BlockId> given_up = parts_.registry.record_update();
  for (const BlockId block : given_up) state_.remove(block);
  if (landmarks_given_ && !given_up.empty()) give_landmarks(true);
}

std::vector<AdaptedNoise> EkfSlam::noise() const {
  std::vector<AdaptedNoise> all;
  if (parts_.noise) all = parts_.noise->noise();
  if (parts_.process) all.push_back(parts_.process->noise());
  return all;
}

std::vector<LandmarkEstimate> EkfSlam::landmarks(bool with_provisional) const {
  std::vector<LandmarkEstimate> map;
  for (const auto& landmark : parts_.registry.landmarks()) {
    if (!landmark.confirmed && !with_provisional) continue;
    map.push_back({landmark.id, std::string(parts_.measurement->landmark_type()),
                   state_.estimate(landmark.block), state_.covariance_of(landmark.block),
                   landmark.times_seen, landmark.extent});
  }
  std::sort(map.begin(), map.end(),
            [](const LandmarkEstimate& a, const LandmarkEstimate& b) { return a.id < b.id; });
  return map;
}

bool EkfSlam::healthy() const {
  const TangentVector variances = state_.covariance_of(pose_).diagonal();
  return state_.estimate(pose_).allFinite() && variances.allFinite() &&
         (variances.array() >= 0.0).all() && calibration_.healthy(state_);
}

}  // namespace libslam
