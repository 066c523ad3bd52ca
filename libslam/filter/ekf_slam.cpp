#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include <libslam/filter/ekf_slam.hpp>

namespace libslam {

namespace {

/// A parameter counts as observed when the data halved its standard deviation.
constexpr double kObservedRatio = 0.5;

EkfSlamParts checked(EkfSlamParts parts) {
  if (!parts.motion || !parts.frame)
    throw std::invalid_argument("EkfSlam needs a motion model and an error frame");
  if (!parts.displacement && (!parts.measurement || !parts.associator))
    throw std::invalid_argument(
        "EkfSlam needs a measurement model and an associator, or a displacement model");
  if (parts.displacement && parts.linearization)
    throw std::invalid_argument("EkfSlam linearizes displacements at the estimate");
  return parts;
}

/// Scales for the excitation: the motion itself is what shows the pose of a sensor.
std::vector<double> nominal_values(const EkfSlamParts& parts) {
  std::vector<double> nominal;
  for (const auto& parameter : parts.motion->calibration())
    nominal.push_back(parameter.prior_mean == 0.0 ? parameter.prior_sigma : parameter.prior_mean);
  if (parts.displacement)
    nominal.resize(nominal.size() + parts.displacement->model().calibration().size(), 1.0);
  return nominal;
}

}  // namespace

UpdateOutcome& UpdateOutcome::operator+=(const UpdateOutcome& other) {
  nis += other.nis;
  nis_dof += other.nis_dof;
  accepted += other.accepted;
  gated += other.gated;
  ambiguous += other.ambiguous;
  new_landmarks += other.new_landmarks;
  verdicts.insert(verdicts.end(), other.verdicts.begin(), other.verdicts.end());
  return *this;
}

/// Innovations of feature-landmark pairs, with a cheap bound that skips pairs far apart.
class EkfSlam::PairTest final : public Compatibility {
 public:
  PairTest(EkfSlam& filter, std::span<const Feature> features)
      : filter_(filter), features_(features) {}

  std::optional<Match> test(std::size_t feature, std::size_t landmark, double limit) override {
    const BlockId block = filter_.parts_.registry.landmarks()[landmark].block;
    if (std::isfinite(limit) && far_apart(feature, block, limit)) return std::nullopt;
    filter_.linearizer_.linearize(*filter_.parts_.measurement, filter_.state_, filter_.pose_, block,
                                  features_[feature], measurement_);
    const Innovation innovation = filter_.ekf_.innovate(filter_.state_, measurement_);
    return Match{innovation.mahalanobis2, innovation.log_det};
  }

 private:
  // In landmark space e = l_feature - l_map has covariance C <= 2 (C_feature + C_map), whatever
  // their correlation, and e^T C^-1 e >= |e|^2 / trace(C).
  bool far_apart(std::size_t feature, BlockId landmark, double limit) {
    const GaussianState& state = filter_.state_;
    if (feature != prepared_) {
      filter_.parts_.measurement->initialize(state, filter_.pose_, features_[feature], where_);
      trace_ = where_.cov_noise.trace();
      for (const auto& [block, jacobian] : where_.wrt) {
        const BlockMatrix spread = jacobian * state.covariance_of(block);
        trace_ += spread.cwiseProduct(jacobian).sum();
      }
      prepared_ = feature;
    }
    const double distance2 = (where_.estimate - state.estimate(landmark)).squaredNorm();
    return distance2 > limit * 2.0 * (trace_ + state.covariance_of(landmark).trace());
  }

  EkfSlam& filter_;
  std::span<const Feature> features_;
  LinearizedMeasurement measurement_;
  Initialization where_;
  std::size_t prepared_ = static_cast<std::size_t>(-1);
  double trace_ = 0.0;
};

EkfSlam::EkfSlam(EkfSlamParts parts)
    : parts_(checked(std::move(parts))),
      ekf_(std::move(parts_.frame)),
      linearizer_(std::move(parts_.linearization)),
      excitation_(nominal_values(parts_)) {
  if (parts_.measurement) {
    ekf_.frame().require_supported(parts_.measurement->landmark_spec());
    linearizer_.require_supported(parts_.measurement->landmark_spec());
  }
  pose_ = state_.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, Eigen::Vector3d::Zero(),
                     parts_.cov_start);
  linearizer_.add_block(state_, pose_);
  add_calibration();
}

void EkfSlam::add_calibration() {
  motion_calibration_ = add_blocks(parts_.motion->calibration());
  if (parts_.displacement)
    sensor_calibration_ = add_blocks(parts_.displacement->model().calibration());
  calibration_ = motion_calibration_;
  calibration_.insert(calibration_.end(), sensor_calibration_.begin(), sensor_calibration_.end());
  calibration_jacobian_.resize(3, static_cast<Eigen::Index>(calibration_.size()));
}

CalibrationBlocks EkfSlam::add_blocks(const std::vector<CalibrationSpec>& parameters) {
  CalibrationBlocks blocks;
  for (const auto& parameter : parameters) {
    parameters_.push_back(parameter);
    blocks.push_back(
        state_.add({parameter.name, Chart::kVector, 1, WorldRole::kNone},
                   Eigen::VectorXd::Constant(1, parameter.prior_mean),
                   Eigen::MatrixXd::Constant(1, 1, parameter.prior_sigma * parameter.prior_sigma)));
    linearizer_.add_block(state_, blocks.back());
  }
  return blocks;
}

void EkfSlam::propagate(const MotionAction* action) {
  const PhaseTimer timer(times_, Phase::kPredict);
  if (action == nullptr) {
    state_.covariance().add_noise(state_.offset(pose_), parts_.cov_no_odometry);
    linearizer_.stood(state_, pose_);
    return;
  }
  linearizer_.linearize(*parts_.motion, state_, pose_, motion_calibration_, *action, step_);
  if (!calibration_.empty()) observe_excitation(action->dt);
  ekf_.propagate(state_, step_);
  linearizer_.moved(state_, pose_);
  for (std::size_t i = 0; i < calibration_.size(); ++i) {
    const double walk = parameters_[i].random_walk;
    if (walk > 0.0 && action->dt > 0.0)
      state_.covariance().add_noise(state_.offset(calibration_[i]),
                                    BlockMatrix::Constant(1, 1, walk * walk * action->dt));
  }
}

void EkfSlam::observe_excitation(double dt) {
  const Eigen::Rotation2Dd R_robot_world(-state_.estimate(pose_)[2]);
  Eigen::Matrix3d to_robot = Eigen::Matrix3d::Identity();
  to_robot.topLeftCorner<2, 2>() = R_robot_world.toRotationMatrix();
  calibration_jacobian_.setZero();
  for (const auto& [block, jacobian] : step_.wrt)
    for (std::size_t i = 0; i < calibration_.size(); ++i)
      if (block == calibration_[i])
        calibration_jacobian_.col(static_cast<Eigen::Index>(i)) = to_robot * jacobian;
  if (parts_.displacement) {
    Eigen::Vector3d moved = to_robot * (step_.estimate - state_.estimate(pose_));
    moved[2] = wrap_angle(moved[2]);
    calibration_jacobian_.rightCols(static_cast<Eigen::Index>(sensor_calibration_.size())) =
        parts_.displacement->model().excitation(moved);
  }
  excitation_.observe(calibration_jacobian_, to_robot * step_.cov_noise * to_robot.transpose(), dt);
  considered_.clear();
  for (std::size_t i = 0; i < calibration_.size(); ++i)
    if (!excitation_.excited(i)) considered_.push_back(calibration_[i]);
}

UpdateOutcome EkfSlam::measure_displacement(const Feature& reading) {
  const PhaseTimer timer(times_, Phase::kUpdate);
  const DisplacementOutcome done =
      parts_.displacement->apply(state_, ekf_, pose_, sensor_calibration_, considered_, reading);
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
  {
    const PhaseTimer timer(times_, Phase::kAssociate);
    PairTest test(*this, features);
    parts_.associator->associate(features, parts_.registry, test, verdicts_);
    accepted_.clear();
    accepted_.reserve(features.size());
    for (std::size_t i = 0; i < features.size(); ++i) {
      const Verdict& verdict = verdicts_[i];
      if (verdict.outcome == Outcome::kGated) ++outcome.gated;
      if (verdict.outcome == Outcome::kAmbiguous) ++outcome.ambiguous;
      if (verdict.outcome != Outcome::kPaired) continue;
      const BlockId landmark = parts_.registry.landmarks()[verdict.landmark].block;
      linearizer_.linearize(*parts_.measurement, state_, pose_, landmark, features[i],
                            accepted_.emplace_back());
    }
  }
  {
    const PhaseTimer timer(times_, Phase::kUpdate);
    const Eigen::Vector2d before = state_.estimate(pose_).head<2>();
    const Correction correction = ekf_.correct(state_, pose_, accepted_, considered_);
    if (correction.applied) {
      linearizer_.corrected(state_, pose_, before);
      outcome.accepted = static_cast<int>(accepted_.size());
      outcome.nis = correction.nis;
      outcome.nis_dof = correction.dof;
    } else {
      // An innovation covariance that is not positive definite: nothing was used.
      for (Verdict& verdict : verdicts_)
        if (verdict.outcome == Outcome::kPaired) verdict.outcome = Outcome::kGated;
      outcome.gated += static_cast<int>(accepted_.size());
    }
  }
  add_landmarks(features, outcome);
  return outcome;
}

void EkfSlam::add_landmarks(std::span<const Feature> features, UpdateOutcome& outcome) {
  const PhaseTimer timer(times_, Phase::kAugment);
  for (const Verdict& verdict : verdicts_)
    if (verdict.outcome == Outcome::kPaired) parts_.registry.record_sighting(verdict.landmark);
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (verdicts_[i].outcome != Outcome::kNew) continue;
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

std::vector<CalibrationValue> EkfSlam::calibration() const {
  std::vector<CalibrationValue> values;
  for (std::size_t i = 0; i < calibration_.size(); ++i) {
    const CalibrationSpec& parameter = parameters_[i];
    const double sigma = std::sqrt(state_.covariance_of(calibration_[i])(0, 0));
    values.push_back(
        {parameter.name, state_.estimate(calibration_[i])[0], sigma, parameter.prior_mean,
         parameter.prior_sigma,
         excitation_.ever_excited(i) && sigma < kObservedRatio * parameter.prior_sigma});
  }
  return values;
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
  const auto pose = state_.estimate(pose_);
  const Eigen::Vector3d variances = state_.covariance_of(pose_).diagonal();
  bool healthy = pose.allFinite() && variances.allFinite() && (variances.array() >= 0.0).all();
  for (const BlockId block : calibration_)
    healthy = healthy && state_.estimate(block).allFinite() &&
              state_.covariance_of(block)(0, 0) >= 0.0 && state_.covariance_of(block).allFinite();
  return healthy;
}

}  // namespace libslam
