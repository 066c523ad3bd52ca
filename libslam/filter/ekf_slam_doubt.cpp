// What EkfSlam does with observations that it doubts, between association and correction.

#include <algorithm>
#include <stdexcept>

#include <libslam/data/step_events.hpp>
#include <libslam/filter/ekf_slam.hpp>

namespace libslam {

void EkfSlam::respond(std::span<const Feature> features, UpdateOutcome& outcome) {
  DisturbanceResponse& response = *parts_.disturbance;
  const RespondingFilter self{state_,
                              pose_,
                              ekf_,
                              *parts_.measurement,
                              parts_.registry,
                              [&] { return associate(features); }};
  const AssociatedObservation observation{features, verdicts_, accepted(), measured_};
  const Doubt doubt = response.answer(self, observation);
  if (doubt == Doubt::kNone) {
    const auto found = landmarks_given_ ? std::nullopt : response.recognize(self, observation);
    if (found) {
      for (const BlockId copy : parts_.registry.clear_younger(DisturbanceResponse::kYoung))
        state_.remove(copy);
      start_again_at(*found, features);
      add_events(outcome.event, "disturbance+relocalized");
    }
    return;
  }
  if (response.began()) add_events(outcome.event, "disturbance");
  if (response.became_lost()) add_events(outcome.event, "lost");
  for (Verdict& verdict : verdicts_)
    if (verdict.outcome == Outcome::kNew || doubt == Doubt::kUnexplained)
      verdict.outcome = Outcome::kAmbiguous;
  if (doubt == Doubt::kUnexplained) linearize_pairs(features);
  if (const auto found = response.search_map(self, features)) {
    start_again_at(*found, features);
    add_events(outcome.event, "relocalized");
  }
}

void EkfSlam::start_again_at(const FoundPose& found, std::span<const Feature> features) {
  if (parts_.delayed) parts_.delayed->restart();
  if (parts_.loop_closure) parts_.loop_closure->restart();
  ekf_.propagate(state_, {pose_, found.T_world_robot, {}, found.cov_uninformed});
  verdicts_.assign(features.size(), {});
  for (const auto& [feature, landmark] : found.pairs)
    verdicts_[feature] = {Outcome::kPaired, landmark};
  linearize_pairs(features);
  parts_.disturbance->pose_found();
}

void EkfSlam::reconsider(UpdateOutcome& outcome) {
  const bool lasts = disturbed();
  const std::span<const BlockId> given(considered_.data(), given_);
  const Eigen::Vector2d before = state_.estimate(pose_).head<2>();
  if (!parts_.disturbance->reconsider(state_, pose_, ekf_, given)) return;
  linearizer_.corrected(state_, pose_, before);
  if (!lasts) add_events(outcome.event, "disturbance");
}

Eigen::MatrixXd EkfSlam::covariance() const {
  const std::span<const BlockId> shadows =
      parts_.disturbance ? parts_.disturbance->shadows() : std::span<const BlockId>();
  std::vector<Eigen::Index> rows;
  for (const BlockId block : state_.blocks())
    if (std::ranges::find(shadows, block) == shadows.end())
      for (Eigen::Index i = 0; i < state_.size(block); ++i)
        rows.push_back(state_.offset(block) + i);
  return state_.full_covariance()(rows, rows);
}

void EkfSlam::lose_pose() {
  if (!parts_.disturbance)
    throw std::invalid_argument("a filter without a response to disturbances keeps its pose");
  parts_.disturbance->lose();
}

void EkfSlam::reject_impossible(std::span<const Feature> features, UpdateOutcome& outcome) {
  if (measured_.empty()) return;
  // Rejected innovations count where they are many: a tracker that froze fails every gate once the
  // odometry is good enough.
  const bool most_rejected = 2 * used_.size() <= measured_.size();
  ekf_.expect(state_, pose_,
              most_rejected ? std::span<const LinearizedMeasurement>(measured_) : accepted(),
              joint_);
  const bool impossible = parts_.implied_input->impossible(joint_);
  parts_.implied_input->restart();
  if (!impossible) return;
  add_events(outcome.event, "impossible_motion");
  for (Verdict& verdict : verdicts_) {
    const bool has_partner =
        verdict.outcome == Outcome::kPaired || verdict.outcome == Outcome::kGated;
    if (has_partner) verdict.outcome = landmarks_given_ ? Outcome::kGated : Outcome::kNew;
  }
  if (!landmarks_given_)
    for (const BlockId block : parts_.registry.clear()) state_.remove(block);
  linearize_pairs(features);
}

}  // namespace libslam
