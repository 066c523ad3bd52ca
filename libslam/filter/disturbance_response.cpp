#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <libslam/filter/disturbance_response.hpp>

namespace libslam {

namespace {

/// So many pairings of an observation make a chance agreement of wrong ones unlikely: three points
/// leave three constraints beside the pose, two leave one. Two will do for a short displacement.
constexpr std::size_t kEnoughPairs = 3, kEnoughPairsNearby = 2;
constexpr double kNearbyScale = 0.4;

void inflate_all(GaussianState& state, double factor) {
  for (const BlockId block : state.blocks()) {
    const Eigen::Index n = state.size(block);
    const PlacedJacobian scaled{state.offset(block),
                                BlockMatrix::Identity(n, n) * std::sqrt(factor)};
    state.covariance().propagate(scaled.offset, {&scaled, 1}, BlockMatrix::Zero(n, n));
  }
}

}  // namespace

DisturbanceResponse::DisturbanceResponse(Disturbance policy, double near_landmark, int lost_after)
    : policy_(std::move(policy)), near_landmark_(near_landmark), lost_after_(lost_after) {
  if (!(near_landmark >= 0.0) || lost_after < 1)
    throw std::invalid_argument("a lost pose needs a distance and a number of updates");
}

void DisturbanceResponse::found() {
  policy_.settle();
  unexplained_ = 0;
}

Doubt DisturbanceResponse::answer(const RespondingFilter& filter,
                                  const AssociatedObservation& observation) {
  const auto counted = evidence(observation);
  double nis = 0.0;
  if (!counted.empty()) {
    filter.ekf.expect(filter.state, filter.pose, counted, joint_);
    nis = Disturbance::squared_distance(joint_);
  }
  const int dof = counted.empty() ? 0 : static_cast<int>(joint_.nu.size());
  const bool unfamiliar = estranged(filter, observation);
  const bool beyond = policy_.judge(nis, dof, unfamiliar);
  if (!policy_.lasts()) {
    unexplained_ = 0;
    return Doubt::kNone;
  }
  if (!beyond) return settle_on(true);
  return unfamiliar ? search(filter) : inflate(filter);
}

bool DisturbanceResponse::estranged(const RespondingFilter& filter,
                                    const AssociatedObservation& observation) const {
  Initialization where;
  std::size_t strangers = 0;
  for (std::size_t i = 0; i < observation.features.size(); ++i) {
    const Feature& feature = observation.features[i];
    if (feature.id != kNoIdentity || observation.verdicts[i].outcome != Outcome::kNew) continue;
    filter.measurement.initialize(filter.state, filter.pose, feature, where);
    const auto near = [&](const RegisteredLandmark& landmark) {
      return (filter.state.estimate(landmark.block) - where.estimate).norm() <= near_landmark_;
    };
    if (std::ranges::any_of(filter.registry.landmarks(), near)) ++strangers;
  }
  return strangers >= 2 && 2 * strangers >= observation.features.size();
}

std::span<const LinearizedMeasurement> DisturbanceResponse::evidence(
    const AssociatedObservation& observation) const {
  const std::size_t gated = observation.identified.size() - observation.paired.size();
  return 2 * gated >= observation.identified.size() ? observation.identified : observation.paired;
}

Doubt DisturbanceResponse::inflate(const RespondingFilter& filter) {
  if (policy_.inflation() == Inflation::kWholeState) {
    inflate_all(filter.state, policy_.factor(joint_));
  } else if (const double scale = policy_.scale(joint_); scale > 0.0) {
    filter.state.covariance().add_noise(filter.state.offset(filter.pose), policy_.added(scale));
  }
  const AssociatedObservation again = filter.associate();
  return settle_on(2 * again.paired.size() >= again.identified.size() && !again.paired.empty());
}

Doubt DisturbanceResponse::search(const RespondingFilter& filter) {
  const Eigen::Index offset = filter.state.offset(filter.pose);
  double before = 0.0;
  for (const double scale : Disturbance::kScales) {
    if (scale > 0.0)
      filter.state.covariance().add_noise(offset, policy_.added(scale) - policy_.added(before));
    before = scale;
    if (plausible(filter, filter.associate(), scale)) return settle_on(true);
  }
  // The displacement stays unknown; the next observation starts from the odometry again.
  filter.state.covariance().add_noise(offset, -policy_.added(before));
  return settle_on(false);
}

bool DisturbanceResponse::plausible(const RespondingFilter& filter,
                                    const AssociatedObservation& observation, double scale) {
  const std::size_t pairs = observation.paired.size();
  if (pairs < (scale <= kNearbyScale ? kEnoughPairsNearby : kEnoughPairs)) return false;
  if (2 * pairs < observation.features.size()) return false;
  filter.ekf.expect(filter.state, filter.pose, observation.paired, joint_);
  return policy_.quiet(Disturbance::squared_distance(joint_), static_cast<int>(joint_.nu.size()));
}

Doubt DisturbanceResponse::settle_on(bool explained) {
  unexplained_ = explained ? 0 : unexplained_ + 1;
  return explained ? Doubt::kDisturbed : Doubt::kUnexplained;
}

}  // namespace libslam
