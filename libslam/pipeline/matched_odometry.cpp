#include <cmath>

#include <Eigen/Dense>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <libslam/pipeline/factory.hpp>
#include <libslam/pipeline/matched_odometry.hpp>
#include <libslam/state/chi_square.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

namespace {

/// Directions of which a match knows less than this are left to the odometry: 1 / (1 m or rad)^2.
constexpr double kLeastInformation = 1.0;
/// Below (0.1 mm or mrad)^2 the covariance of the odometry is not inverted.
constexpr double kSmallestVar = 1e-8;
constexpr double kSlip = 0.999;

CalibrationParameters errors_of_wheels() {
  CalibrationParameters errors;
  errors.scale_speed.enabled = errors.scale_turn.enabled = errors.bias_turn.enabled = true;
  return errors;
}

Eigen::Matrix3d rotation_of(double heading) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(heading).toRotationMatrix();
  return rotation;
}

Eigen::Matrix3d rotate(double heading, const Eigen::Matrix3d& cov) {
  const Eigen::Matrix3d rotation = rotation_of(heading);
  return rotation * cov * rotation.transpose();
}

Eigen::Matrix3d positive_part(const Eigen::Matrix3d& cov) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(cov);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

}  // namespace

MatchedOdometry::MatchedOdometry(const Parameters& parameters)
    : matcher_(parameters.input.scan_matching),
      sensor_label_(parameters.input.sensor_label),
      distance_(parameters.input.scan_matching.distance),
      turn_(to_radians(parameters.input.scan_matching.turn_deg)),
      wheels_(make_motion_model(parameters.motion, errors_of_wheels(), parameters.input)),
      ekf_(std::make_unique<StandardFrame>()) {
  for (const CalibrationSpec& error : wheels_->calibration())
    errors_.push_back(
        state_.add({error.name}, Eigen::Matrix<double, 1, 1>(error.prior_mean),
                   Eigen::Matrix<double, 1, 1>(error.prior_sigma * error.prior_sigma)));
  place_at_reference();
}

void MatchedOdometry::place_at_reference() {
  if (pose_.valid()) state_.remove(pose_);
  pose_ = state_.add(wheels_->pose_spec(), Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero());
  T_reference_robot_.setZero();
  cov_handed_on_.setZero();
}

bool MatchedOdometry::look(const LogStep& step) {
  if (!step.frame) return false;
  for (const auto& any : *step.frame) {
    const auto* scan = dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(any.get());
    if (scan == nullptr || (!sensor_label_.empty() && scan->sensorLabel != sensor_label_)) continue;
    if (is_level(*scan)) return matcher_.look(*scan);
  }
  return false;
}

void MatchedOdometry::refine(const LogStep& step, MotionAction& action) {
  const Eigen::Vector3d increment = move(action);
  const bool sees = look(step);
  const bool matched = sees && referenced_ && match();
  if (matched)
    hand_on(matched_.estimate(pose_), matched_.covariance_of(pose_), action);
  else
    hand_on_unmatched(increment, action);
  if (sees && (!referenced_ || is_far(T_reference_robot_))) renew_reference(matched && !slipped_);
}

Eigen::Vector3d MatchedOdometry::move(const MotionAction& action) {
  const Eigen::Vector3d before = state_.estimate(pose_);
  wheels_->linearize(state_, pose_, errors_, action, motion_step_);
  ekf_.propagate(state_, motion_step_);
  return relative_pose(before, state_.estimate(pose_));
}

bool MatchedOdometry::match() {
  Eigen::Matrix3d cov = state_.covariance_of(pose_);
  cov.diagonal().array() += kSmallestVar;
  const auto match = matcher_.match(state_.estimate(pose_), cov.inverse());
  ++matches_;
  if (match) {
    iterations_ += match->iterations;
    fill_measurement(*match);
  }
  if (!match || measurement_.innovation.size() == 0) {
    ++failed_;
    return false;
  }
  matched_ = state_;
  const auto rows = static_cast<int>(measurement_.innovation.size());
  const double distance2 = ekf_.innovate(matched_, measurement_).mahalanobis2;
  slipped_ = distance2 > chi_square_quantile(kSlip, rows);
  if (slipped_) {
    ++slips_;
    widen_pose(distance2 / rows);
  }
  return ekf_.correct(matched_, pose_, {&measurement_, 1}).applied;
}

/// One row per direction that the match knows something of, free of correlations.
void MatchedOdometry::fill_measurement(const ScanMatch& match) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(match.information);
  const auto blind = (eigen.eigenvalues().array() < kLeastInformation).count();
  const Eigen::Index rows = 3 - blind;  // eigenvalues are in increasing order
  const Eigen::VectorXd known = eigen.eigenvalues().tail(rows);
  const Eigen::MatrixXd directions = eigen.eigenvectors().rightCols(rows).transpose();
  measurement_.innovation = (directions * match.pull).cwiseQuotient(known);
  measurement_.wrt.clear();
  measurement_.wrt.add(pose_, rows, 3) = directions;
  measurement_.cov = known.cwiseInverse().asDiagonal();
}

void MatchedOdometry::widen_pose(double factor) {
  motion_step_.target = pose_;
  motion_step_.estimate = matched_.estimate(pose_);
  motion_step_.wrt.clear();
  motion_step_.wrt.add(pose_, 3, 3).setIdentity();
  motion_step_.cov_noise = (factor - 1.0) * matched_.covariance_of(pose_);
  ekf_.propagate(matched_, motion_step_);
}

void MatchedOdometry::hand_on(const Eigen::Vector3d& pose, const Eigen::Matrix3d& cov,
                              MotionAction& action) {
  const Eigen::Vector3d moved = pose - T_reference_robot_;
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 2) = -moved.y();
  F(1, 2) = moved.x();
  const Eigen::Matrix3d carried = F * cov_handed_on_ * F.transpose();
  const Eigen::Matrix3d own = positive_part(cov - carried);
  action.increment = relative_pose(T_reference_robot_, pose);
  action.cov_increment = rotate(-T_reference_robot_[2], own);
  T_reference_robot_ = pose;
  cov_handed_on_ = carried + own;
}

void MatchedOdometry::hand_on_unmatched(const Eigen::Vector3d& increment, MotionAction& action) {
  const Eigen::Vector3d pose = compose_poses(T_reference_robot_, increment);
  const Eigen::Vector3d moved = pose - T_reference_robot_;
  const double heading = state_.estimate(pose_)[2] - increment[2];  // before the step
  const Eigen::Matrix3d cov = rotate(-heading, motion_step_.cov_noise);
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 2) = -moved.y();
  F(1, 2) = moved.x();
  cov_handed_on_ = F * cov_handed_on_ * F.transpose() + rotate(T_reference_robot_[2], cov);
  action.increment = increment;
  action.cov_increment = cov;
  T_reference_robot_ = pose;
}

bool MatchedOdometry::is_far(const Eigen::Vector3d& pose) const {
  return pose.head<2>().norm() >= distance_ || std::abs(pose[2]) >= turn_;
}

void MatchedOdometry::renew_reference(bool learned) {
  if (learned) state_ = matched_;
  matcher_.renew_reference();
  place_at_reference();
  referenced_ = true;
}

std::map<std::string, double> MatchedOdometry::figures() const {
  std::map<std::string, double> figures = {{"matches", static_cast<double>(matches_)},
                                           {"matches_failed", static_cast<double>(failed_)},
                                           {"slips", static_cast<double>(slips_)}};
  if (matches_ > failed_)
    figures["match_iterations"] =
        static_cast<double>(iterations_) / static_cast<double>(matches_ - failed_);
  for (const BlockId error : errors_)
    figures["odometry_" + state_.spec(error).name] = state_.estimate(error)[0];
  return figures;
}

}  // namespace libslam
