#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <mrpt/math/TPose2D.h>
#include <mrpt/tfest/TMatchingPair.h>
#include <mrpt/tfest/se2.h>

#include <libslam/association/pose_fit.hpp>
#include <libslam/filter/relocalizer.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {

namespace {

constexpr std::size_t kLeastByIdentity = 3;  // one more than fixes a pose, to test it
constexpr double kFitProbability = 0.999;
constexpr std::size_t kLeastLatest = 2;  // pairs that fix the pose in the correction
constexpr double kUninformedRanges = 100.0, kUninformedHeading = 10.0;
constexpr double kReserve = 1.5;  // distances are indexed beyond what is needed today

double largest_distance(std::span<const PlanarPoint> points) {
  double largest = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      largest = std::max(largest, (points[i].position - points[k].position).norm());
  return largest;
}

/// Of the landmarks of `pairs`, with all cross terms.
Eigen::MatrixXd joint_covariance(const GaussianState& state, const LandmarkRegistry& registry,
                                 std::span<const Pairing> pairs) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  const auto block = [&](Eigen::Index k) {
    return registry.landmarks()[pairs[static_cast<std::size_t>(k)].landmark].block;
  };
  Eigen::MatrixXd cov(2 * n, 2 * n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k)
      cov.block<2, 2>(2 * i, 2 * k) = state.cross_covariance(block(i), block(k));
  return cov;
}

}  // namespace

void Relocalizer::restart() {
  sightings_.clear();
  latest_.clear();
  map_.reset();
}

void Relocalizer::move(const Eigen::Vector3d& before, const Eigen::Vector3d& after,
                       const Eigen::Matrix3d& cov) {
  if (sightings_.points().empty()) return;
  Eigen::Matrix3d to_robot = Eigen::Matrix3d::Identity();
  to_robot.topLeftCorner<2, 2>() = rotation_of(before).transpose();
  Eigen::Vector3d increment = to_robot * (after - before);
  increment[2] = wrap_angle(increment[2]);
  sightings_.move(increment, to_robot * cov * to_robot.transpose());
}

void Relocalizer::observe(const GaussianState& state, BlockId pose,
                          const MeasurementModel& measurement, std::span<const Feature> features) {
  const Eigen::Vector3d T_world_robot = state.estimate(pose);
  const Eigen::Matrix2d R_robot_world = rotation_of(T_world_robot).transpose();
  SensorView view;
  Initialization where;
  latest_.clear();
  identities_.clear();
  for (const Feature& feature : features) {
    measurement.initialize(state, pose, feature, where);
    const Eigen::Vector2d place =
        R_robot_world * (Eigen::Vector2d(where.estimate) - T_world_robot.head<2>());
    latest_.push_back({place, R_robot_world * where.cov_noise * R_robot_world.transpose()});
    identities_.push_back(feature.id);
    view.T_robot_sensor = feature.T_robot_sensor;
    const Eigen::Vector2d ray = place - feature.T_robot_sensor.head<2>();
    const double bearing = std::atan2(ray.y(), ray.x()) - feature.T_robot_sensor[2];
    max_range_ = std::max(max_range_, ray.norm());
    max_bearing_ = std::max(max_bearing_, std::abs(wrap_angle(bearing)));
  }
  view.max_range = max_range_;
  view.field_of_view = 2.0 * max_bearing_;
  sightings_.add(latest_, view);
}

std::optional<FoundPose> Relocalizer::find(const GaussianState& state,
                                           const LandmarkRegistry& registry) {
  const bool identified =
      std::ranges::any_of(identities_, [](std::int64_t id) { return id != kNoIdentity; });
  return identified ? find_by_identity(state, registry) : find_by_constellation(state, registry);
}

// The map changes from search to search while the robot believes that it knows where it is.
std::optional<FoundPose> Relocalizer::find_among_older(const GaussianState& state,
                                                       const LandmarkRegistry& registry, int age) {
  map_.reset();
  least_age_ = age;
  auto pose = find_by_constellation(state, registry);
  map_.reset();
  least_age_ = 0;
  return pose;
}

std::optional<FoundPose> Relocalizer::find_by_identity(const GaussianState& state,
                                                       const LandmarkRegistry& registry) const {
  std::vector<PlanarPoint> mapped(latest_.size());
  std::vector<Pairing> pairs;
  std::vector<PointPair> points;
  mrpt::tfest::TMatchingPairList matches;
  for (std::size_t i = 0; i < latest_.size(); ++i) {
    const auto landmark = registry.find(identities_[i]);
    if (!landmark || identities_[i] == kNoIdentity) continue;
    const BlockId block = registry.landmarks()[*landmark].block;
    mapped[i] = {state.estimate(block), state.covariance_of(block)};
    pairs.push_back({i, *landmark});
    points.push_back({&latest_[i], &mapped[i]});
    const Eigen::Vector2f place = mapped[i].position.cast<float>();
    const Eigen::Vector2f seen = latest_[i].position.cast<float>();
    const auto number = static_cast<std::uint32_t>(i);
    matches.emplace_back(number, number, place.x(), place.y(), 0.0F, seen.x(), seen.y(), 0.0F);
  }
  mrpt::math::TPose2D start;
  if (pairs.size() < kLeastByIdentity || !mrpt::tfest::se2_l2(matches, start)) return std::nullopt;
  const PoseFit fit =
      fit_pose(points, joint_covariance(state, registry, pairs), {start.x, start.y, start.phi});
  const int dof = 2 * static_cast<int>(pairs.size()) - 3;
  if (!(fit.mahalanobis2 <= chi_square_quantile(kFitProbability, dof))) return std::nullopt;
  FoundPose pose = found(fit.T_world_robot, fit.cov);
  pose.pairs = std::move(pairs);
  return pose;
}

// Relative to its neighbours a landmark is known much better than in the world, where the drift of
// the whole map counts: half of the mean covariance of the differences to those within `reach`.
void Relocalizer::index(const GaussianState& state, const LandmarkRegistry& registry,
                        double reach) {
  landmarks_.clear();
  for (std::size_t k = 0; k < registry.size(); ++k)
    if (registry.landmarks()[k].confirmed && registry.landmarks()[k].updates >= least_age_)
      landmarks_.push_back(k);
  std::vector<PlanarPoint> points;
  for (const std::size_t k : landmarks_) {
    const BlockId block = registry.landmarks()[k].block;
    const Eigen::Vector2d place = state.estimate(block);
    const Eigen::Matrix2d own = state.covariance_of(block);
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    int neighbours = 0;
    for (const std::size_t other : landmarks_) {
      const BlockId near = registry.landmarks()[other].block;
      if (other == k || (state.estimate(near) - place).norm() > reach) continue;
      const Eigen::Matrix2d cross = state.cross_covariance(block, near);
      sum += own + state.covariance_of(near) - cross - cross.transpose();
      ++neighbours;
    }
    points.push_back({place, neighbours > 0 ? Eigen::Matrix2d(0.5 / neighbours * sum) : own});
  }
  map_ = std::make_unique<ConstellationIndex>(std::move(points), reach, max_range_);
  reach_ = reach;
}

std::optional<FoundPose> Relocalizer::find_by_constellation(const GaussianState& state,
                                                            const LandmarkRegistry& registry) {
  const std::vector<PlanarPoint>& seen = sightings_.points();
  const double needed = largest_distance(seen);
  if (seen.size() < ConstellationOptions{}.least_pairs || needed <= 0.0) return std::nullopt;
  if (!map_ || needed > reach_) index(state, registry, kReserve * needed);
  const ConstellationMatch match = match_constellation(*map_, seen, sightings_.views());
  if (match.verdict != ConstellationVerdict::kFound) return std::nullopt;
  FoundPose pose = found(match.T_world_robot, match.cov);
  for (const Pairing& pair : match.pairs)
    if (const auto feature = latest_of(seen[pair.feature]))
      pose.pairs.push_back({*feature, landmarks_[pair.landmark]});
  if (pose.pairs.size() < kLeastLatest) return std::nullopt;
  return pose;
}

std::optional<std::size_t> Relocalizer::latest_of(const PlanarPoint& sighting) const {
  static const double kGate = chi_square_quantile(kFitProbability, 2);
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < latest_.size(); ++i) {
    const Eigen::Vector2d e = latest_[i].position - sighting.position;
    if (e.dot((latest_[i].cov + sighting.cov).inverse() * e) > kGate) continue;
    if (best) return std::nullopt;
    best = i;
  }
  return best;
}

FoundPose Relocalizer::found(const Eigen::Vector3d& pose, const Eigen::Matrix3d& cov) const {
  const double sigma = kUninformedRanges * max_range_;
  FoundPose found;
  found.T_world_robot = pose;
  found.cov = cov;
  found.cov_uninformed = Eigen::Vector3d(sigma, sigma, kUninformedHeading).cwiseAbs2().asDiagonal();
  return found;
}

}  // namespace libslam
