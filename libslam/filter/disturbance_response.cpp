#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>

#include <libslam/filter/disturbance_response.hpp>

namespace libslam {

namespace {

/// So many pairings of an observation make a chance agreement of wrong ones unlikely: three points
/// leave three constraints beside the pose, two leave one. Two will do for a short displacement.
constexpr std::size_t kEnoughPairs = 3, kEnoughPairsNearby = 2;
constexpr double kNearbyScale = 0.4;
/// Updates in a row of which half or more fits nothing: with gates of .99 once in a million.
constexpr int kPersistent = 3;
/// Updates from search to search while nothing is in doubt.
constexpr int kSearchPeriod = 5;

void inflate_all(GaussianState& state, double factor) {
  for (const BlockId block : state.blocks()) {
    const Eigen::Index n = state.size(block);
    const PlacedJacobian scaled{state.offset(block),
                                BlockMatrix::Identity(n, n) * std::sqrt(factor)};
    state.covariance().propagate(scaled.offset, {&scaled, 1}, BlockMatrix::Zero(n, n));
  }
}

bool has_identities(std::span<const Feature> features) {
  return std::ranges::any_of(features,
                             [](const Feature& feature) { return feature.id != kNoIdentity; });
}

}  // namespace

DisturbanceResponse::DisturbanceResponse(Disturbance policy, const ResponseOptions& options)
    : policy_(std::move(policy)), options_(options) {
  if (!(options.near_landmark >= 0.0) || options.lost_after < 1)
    throw std::invalid_argument("a lost pose needs a distance and a number of updates");
  if (options.slip_probability != 0.0) hindsight_.emplace(options.slip_probability);
}

void DisturbanceResponse::open(GaussianState& state, BlockId pose) {
  if (hindsight_) hindsight_->open(state, pose);
}

bool DisturbanceResponse::reconsider(GaussianState& state, BlockId pose, Ekf& ekf,
                                     std::span<const BlockId> given) {
  if (!hindsight_ || !hindsight_->reconsider(state, pose, ekf, given)) return false;
  policy_.begin();
  return true;
}

std::span<const BlockId> DisturbanceResponse::shadows() const {
  return hindsight_ ? hindsight_->shadows() : std::span<const BlockId>();
}

void DisturbanceResponse::pose_found() {
  settle();
  if (hindsight_) hindsight_->forget();
}

void DisturbanceResponse::lose() {
  relocalizer_.restart();
  unexplained_ = options_.lost_after;
}

void DisturbanceResponse::settle() {
  unexplained_ = unpaired_ = 0;
  vanished_ = false;
}

void DisturbanceResponse::moved(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                                const BlockMatrix& cov) {
  if (options_.relocalize) relocalizer_.move(before, after, cov);
}

Doubt DisturbanceResponse::answer(const RespondingFilter& filter,
                                  const AssociatedObservation& observation) {
  if (lost() && options_.relocalize && !has_identities(observation.features))
    return stay_lost(filter, observation);
  const auto counted = evidence(observation);
  double nis = 0.0;
  if (!counted.empty()) {
    filter.ekf.expect(filter.state, filter.pose, counted, joint_);
    nis = Disturbance::squared_distance(joint_);
  }
  const int dof = counted.empty() ? 0 : static_cast<int>(joint_.nu.size());
  const bool pairs_fit = observation.paired.size() >= kEnoughPairsNearby && policy_.quiet(nis, dof);
  const bool unfamiliar = estranged(filter, observation, pairs_fit);
  const bool beyond = policy_.judge(nis, dof, unfamiliar);
  if (policy_.began()) relocalizer_.restart();
  if (!policy_.lasts()) {
    unexplained_ = 0;
    return Doubt::kNone;
  }
  if (!beyond) return settle_on(true);
  return unfamiliar ? search(filter) : inflate(filter);
}

bool DisturbanceResponse::estranged(const RespondingFilter& filter,
                                    const AssociatedObservation& observation, bool pairs_fit) {
  Initialization where;
  std::size_t strangers = 0, undecided = 0, fresh = 0;
  for (std::size_t i = 0; i < observation.features.size(); ++i) {
    const Feature& feature = observation.features[i];
    if (feature.id != kNoIdentity) continue;
    if (observation.verdicts[i].outcome == Outcome::kAmbiguous) ++undecided;
    if (observation.verdicts[i].outcome != Outcome::kNew) continue;
    ++fresh;
    filter.measurement.initialize(filter.state, filter.pose, feature, where);
    const auto near = [&](const RegisteredLandmark& landmark) {
      return (filter.state.estimate(landmark.block) - where.estimate).norm() <=
             options_.near_landmark;
    };
    if (std::ranges::any_of(filter.registry.landmarks(), near)) ++strangers;
  }
  const std::size_t n = observation.features.size(), unpaired = strangers + undecided;
  const bool fits_nothing = !pairs_fit && unpaired > 0 && 2 * unpaired >= n;
  unpaired_ = fits_nothing ? unpaired_ + 1 : 0;
  const std::size_t pairs = observation.paired.size();
  const bool all_changed = pairs == 0 && fresh >= 2 && last_pairs_ >= 2;
  vanished_ = all_changed || (vanished_ && pairs < 2);
  last_pairs_ = pairs;
  return vanished_ || unpaired_ >= kPersistent ||
         (fits_nothing && strangers >= 2 && 2 * strangers >= n);
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
  if (again.paired.empty()) return settle_on(false);
  const auto counted = evidence(again);
  filter.ekf.expect(filter.state, filter.pose, counted, joint_);
  const bool fits =
      policy_.possible(Disturbance::squared_distance(joint_), static_cast<int>(joint_.nu.size()));
  // A pose too far off to be linearized at: with enough landmarks the map shows the right one.
  if (fits || counted.size() < kEnoughPairs || !options_.relocalize) {
    settle_on(fits);
    return Doubt::kDisturbed;
  }
  return settle_on(false);
}

Doubt DisturbanceResponse::search(const RespondingFilter& filter) {
  const Eigen::Index offset = filter.state.offset(filter.pose);
  double before = 0.0;
  for (const double scale : Disturbance::kScales) {
    if (scale > 0.0)
      filter.state.covariance().add_noise(offset, policy_.added(scale) - policy_.added(before));
    before = scale;
    const std::size_t enough = scale <= kNearbyScale ? kEnoughPairsNearby : kEnoughPairs;
    if (plausible(filter, filter.associate(), enough)) return settle_on(true);
  }
  // The displacement stays unknown; the next observation starts from the odometry again.
  filter.state.covariance().add_noise(offset, -policy_.added(before));
  return settle_on(false);
}

// By chance alone so many landmarks do not stand where a lost robot expects them.
Doubt DisturbanceResponse::stay_lost(const RespondingFilter& filter,
                                     const AssociatedObservation& observation) {
  if (!plausible(filter, observation, kEnoughPairs)) return settle_on(false);
  settle();
  return Doubt::kDisturbed;
}

std::optional<FoundPose> DisturbanceResponse::search_map(const RespondingFilter& filter,
                                                         std::span<const Feature> features) {
  if (!options_.relocalize || !disturbed()) return std::nullopt;
  relocalizer_.observe(filter.state, filter.pose, filter.measurement, features);
  // Identities leave nothing to guess: no need to wait.
  const bool sure = unexplained_ > 0 && has_identities(features);
  if (!lost() && !sure) return std::nullopt;
  return relocalizer_.find(filter.state, filter.registry);
}

// Landmarks of the map that stand elsewhere are no sign of a disturbance to the associator: what
// fits nothing near is new. Their constellation tells.
std::optional<FoundPose> DisturbanceResponse::recognize(const RespondingFilter& filter,
                                                        const AssociatedObservation& observation) {
  if (!options_.relocalize || has_identities(observation.features)) return std::nullopt;
  relocalizer_.observe(filter.state, filter.pose, filter.measurement, observation.features);
  const auto landmarks = filter.registry.landmarks();
  const auto known = std::ranges::count_if(observation.verdicts, [&](const Verdict& verdict) {
    return verdict.outcome == Outcome::kPaired && landmarks[verdict.landmark].updates >= kYoung;
  });
  if (++searched_ < kSearchPeriod || observation.features.empty() ||
      2 * static_cast<std::size_t>(known) >= observation.features.size())
    return std::nullopt;
  searched_ = 0;
  const auto found = relocalizer_.find_among_older(filter.state, filter.registry, kYoung);
  if (!found) return std::nullopt;
  Eigen::Vector3d apart = found->T_world_robot - filter.state.estimate(filter.pose);
  apart[2] = wrap_angle(apart[2]);
  const Eigen::Matrix3d cov = found->cov + filter.state.covariance_of(filter.pose);
  if (policy_.possible(apart.dot(cov.ldlt().solve(apart)), 3)) return std::nullopt;
  policy_.begin();
  return found;
}

bool DisturbanceResponse::plausible(const RespondingFilter& filter,
                                    const AssociatedObservation& observation,
                                    std::size_t enough_pairs) {
  const std::size_t pairs = observation.paired.size();
  if (pairs < enough_pairs || 2 * pairs < observation.features.size()) return false;
  filter.ekf.expect(filter.state, filter.pose, observation.paired, joint_);
  return policy_.quiet(Disturbance::squared_distance(joint_), static_cast<int>(joint_.nu.size()));
}

Doubt DisturbanceResponse::settle_on(bool explained) {
  unexplained_ = explained ? 0 : unexplained_ + 1;
  return explained ? Doubt::kDisturbed : Doubt::kUnexplained;
}

}  // namespace libslam
