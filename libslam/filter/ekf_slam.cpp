#include <algorithm>
#include <stdexcept>
#include <string>

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
  if (parts.displacement && parts.linearization)
    throw std::invalid_argument("EkfSlam linearizes displacements at the estimate");
  if (parts.map && (parts.displacement || parts.linearization))
    throw std::invalid_argument(
        "EkfSlam starts in a map with a measurement model of landmarks, linearized at the "
        "estimate");
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
  if (!other.event.empty()) event = other.event;
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
  if (parts_.map) start_in_map();
}

void EkfSlam::start_in_map() {
  enter_map(*parts_.map,
            {state_, pose_, calibration_, parts_.registry, parts_.measurement->landmark_spec()});
  landmarks_given_ = parts_.map->landmarks_given;
  parts_.map.reset();
  if (!landmarks_given_) return;
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
  const auto calibration = calibration_.considered();
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
  if (!calibration_.empty())
    calibration_.observe(state_, pose_, step_, action->dt, displacement_model());
  ekf_.propagate(state_, step_);
  if (parts_.implied_input)
    parts_.implied_input->move(step_.wrt.begin()->jacobian, step_.cov_noise);
  linearizer_.moved(state_, pose_);
  calibration_.diffuse(state_, action->dt);
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
  associate(features, outcome);
  if (!reject_motion(outcome)) correct(features, outcome);
  add_landmarks(features, outcome);
  return outcome;
}

void EkfSlam::associate(std::span<const Feature> features, UpdateOutcome& outcome) {
  const PhaseTimer timer(times_, Phase::kAssociate);
  PairTest test({state_, pose_, ekf_, linearizer_, *parts_.measurement, parts_.registry}, features);
  parts_.associator->associate(features, parts_.registry, test, verdicts_);
  accepted_.clear();
  accepted_.reserve(features.size());
  used_.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    Verdict& verdict = verdicts_[i];
    if (landmarks_given_ && verdict.outcome == Outcome::kNew) verdict.outcome = Outcome::kAmbiguous;
    if (verdict.outcome == Outcome::kGated) ++outcome.gated;
    if (verdict.outcome == Outcome::kAmbiguous) ++outcome.ambiguous;
    if (verdict.outcome != Outcome::kPaired) continue;
    const BlockId landmark = parts_.registry.landmarks()[verdict.landmark].block;
    linearizer_.linearize(*parts_.measurement, state_, pose_, landmark, features[i],
                          accepted_.emplace_back());
    used_.push_back(i);
  }
}

bool EkfSlam::reject_motion(UpdateOutcome& outcome) {
  if (!parts_.implied_input || accepted_.empty()) return false;
  ekf_.expect(state_, pose_, accepted_, joint_);
  const bool impossible = parts_.implied_input->impossible(joint_);
  parts_.implied_input->restart();
  if (!impossible) return false;
  outcome.event = "impossible_motion";
  outcome.gated += static_cast<int>(accepted_.size());
  for (Verdict& verdict : verdicts_) {
    if (verdict.outcome == Outcome::kPaired) verdict.outcome = Outcome::kGated;
    if (!landmarks_given_ && verdict.outcome == Outcome::kGated) verdict.outcome = Outcome::kNew;
  }
  if (landmarks_given_) return true;
  for (const BlockId block : parts_.registry.clear()) state_.remove(block);
  return true;
}

void EkfSlam::correct(std::span<const Feature> features, UpdateOutcome& outcome) {
  const PhaseTimer timer(times_, Phase::kUpdate);
  const Eigen::Vector2d before = state_.estimate(pose_).head<2>();
  const Correction correction = ekf_.correct(state_, pose_, accepted_, considered());
  if (correction.applied) {
    linearizer_.corrected(state_, pose_, before);
    outcome.accepted = static_cast<int>(accepted_.size());
    outcome.nis = correction.nis;
    outcome.nis_dof = correction.dof;
    if (parts_.noise) {
      ekf_.look_back(accepted_, postfits_);
      for (std::size_t i = 0; i < used_.size(); ++i) postfits_[i].feature = used_[i];
      parts_.noise->observe(features, postfits_);
    }
  } else {
    // An innovation covariance that is not positive definite: nothing was used.
    for (Verdict& verdict : verdicts_)
      if (verdict.outcome == Outcome::kPaired) verdict.outcome = Outcome::kGated;
    outcome.gated += static_cast<int>(accepted_.size());
  }
}

void EkfSlam::add_landmarks(std::span<const Feature> features, UpdateOutcome& outcome) {
  const PhaseTimer timer(times_, Phase::kAugment);
  for (const Verdict& verdict : verdicts_)
    if (verdict.outcome == Outcome::kPaired) parts_.registry.record_sighting(verdict.landmark);
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
    parts_.registry.add(block, features[i].id);
    ++outcome.new_landmarks;
  }
  outcome.verdicts = verdicts_;
  for (const BlockId given_up : parts_.registry.record_update()) state_.remove(given_up);
}

std::vector<LandmarkEstimate> EkfSlam::landmarks(bool with_provisional) const {
  std::vector<LandmarkEstimate> map;
  for (const auto& landmark : parts_.registry.landmarks()) {
    if (!landmark.confirmed && !with_provisional) continue;
    map.push_back({landmark.id, "point", state_.estimate(landmark.block),
                   state_.covariance_of(landmark.block), landmark.times_seen});
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
