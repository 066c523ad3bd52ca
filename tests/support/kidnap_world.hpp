#pragma once
// A robot set down anywhere in a mapped world: what it sees while it drives on, and whether the
// constellation of that tells where it is.

#include <cmath>
#include <ctime>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <libslam/association/constellation.hpp>
#include <libslam/association/recent_sightings.hpp>
#include <libslam/state/block.hpp>

namespace libslam::testing {

struct KidnapOptions {
  double unmapped = 0.0;  ///< part of what is seen that is not in the map, on average
  double max_range = 30.0, field_of_view = 3.14159265358979323846;
  double sigma_range = 0.2, sigma_bearing = 2.0 * 3.14159265358979323846 / 180.0;
  double sigma_landmark = 0.1;  ///< error of the map, each coordinate
  double step_length = 0.6;     ///< per frame: 3 m/s, five frames a second
  double turn_sigma = 0.05;     ///< of the heading change that is driven per frame [rad]
  double sigma_forward = 0.01, sigma_turn = 0.002;  ///< odometry noise per frame
  std::size_t frames = 20;
  std::size_t least_visible = 4;  ///< mapped landmarks in the first view
};

struct KidnapOutcome {
  std::optional<std::size_t> frame;  ///< the first that found a pose, if any
  /// Within 2 m and 10 degrees of the truth: the right place. A pose from four far points has up to
  /// .4 m of standard deviation, a wrong place is tens of metres away; `nees` judges the precision.
  bool right = false;
  double nees = 0.0;  ///< of the pose found, 3 degrees of freedom
  double log_odds = 0.0;
  ConstellationVerdict last = ConstellationVerdict::kTooFew;
  double slowest_ms = 0.0;  ///< CPU time of one match
};

/// One kidnap in a world of landmarks `truth`; unmapped objects stand in the bounding box.
class KidnapWorld {
 public:
  KidnapWorld(std::vector<Eigen::Vector2d> truth, const KidnapOptions& options, std::uint64_t seed)
      : options_(options), random_(seed), landmarks_(std::move(truth)) {
    least_ = most_ = landmarks_.front();
    for (const auto& p : landmarks_) {
      least_ = least_.cwiseMin(p);
      most_ = most_.cwiseMax(p);
    }
    std::vector<PlanarPoint> map;
    const double variance = options.sigma_landmark * options.sigma_landmark;
    for (const auto& p : landmarks_)
      map.push_back({p + options.sigma_landmark * Eigen::Vector2d(normal(), normal()),
                     variance * Eigen::Matrix2d::Identity()});
    index_.emplace(std::move(map), 2.0 * options.max_range + 20.0, options.max_range);
    const double ratio = options.unmapped / (1.0 - options.unmapped);
    const auto objects =
        static_cast<int>(std::lround(ratio * static_cast<double>(landmarks_.size())));
    for (int i = 0; i < objects; ++i) objects_.push_back(anywhere());
  }

  const ConstellationIndex& index() const { return *index_; }

  /// Drives from a random pose that sees enough, on through the mapped world; nothing if there is
  /// none in 10 000 draws.
  std::optional<KidnapOutcome> kidnap(const ConstellationOptions& matching) {
    if (!set_down()) return std::nullopt;
    KidnapOutcome outcome;
    RecentSightings recent(options_.frames);
    for (std::size_t frame = 1; frame <= options_.frames; ++frame) {
      if (frame > 1) drive(recent);
      recent.add(look(), {Eigen::Vector3d::Zero(), options_.max_range, options_.field_of_view});
      const double begin = cpu_ms();
      const ConstellationMatch match =
          match_constellation(*index_, recent.points(), recent.views(), matching);
      outcome.slowest_ms = std::max(outcome.slowest_ms, cpu_ms() - begin);
      outcome.last = match.verdict;
      if (match.verdict != ConstellationVerdict::kFound) continue;
      Eigen::Vector3d error = match.T_world_robot - pose_;
      error[2] = wrap_angle(error[2]);
      outcome.frame = frame;
      outcome.right = error.head<2>().norm() < 2.0 && std::abs(error[2]) < 0.175;
      outcome.nees = error.dot(match.cov.inverse() * error);
      outcome.log_odds = match.log_odds;
      break;
    }
    return outcome;
  }

 private:
  static double cpu_ms() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  }
  double normal() { return std::normal_distribution<double>()(random_); }
  Eigen::Vector2d anywhere() {
    std::uniform_real_distribution<double> x(least_.x(), most_.x()), y(least_.y(), most_.y());
    const double drawn = x(random_);
    return {drawn, y(random_)};
  }
  std::optional<Eigen::Vector2d> in_view(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d d = p - pose_.head<2>();
    const Eigen::Vector2d polar(d.norm(), wrap_angle(std::atan2(d.y(), d.x()) - pose_[2]));
    if (polar[0] > options_.max_range || polar[0] < 0.5 ||
        std::abs(polar[1]) > 0.5 * options_.field_of_view)
      return std::nullopt;
    return polar;
  }
  bool set_down() {
    std::uniform_real_distribution<double> heading(-3.14159265358979323846, 3.14159265358979323846);
    for (int draw = 0; draw < 10'000; ++draw) {
      pose_ << anywhere(), heading(random_);
      const double way = options_.step_length * static_cast<double>(options_.frames);
      const Eigen::Vector2d end =
          pose_.head<2>() + way * Eigen::Vector2d(std::cos(pose_[2]), std::sin(pose_[2]));
      if ((end.array() < least_.array()).any() || (end.array() > most_.array()).any()) continue;
      std::size_t visible = 0;
      for (const auto& p : landmarks_) visible += in_view(p).has_value();
      if (visible >= options_.least_visible) return true;
    }
    return false;
  }
  void see(const Eigen::Vector2d& p, std::vector<PlanarPoint>& seen) {
    const auto polar = in_view(p);
    if (!polar) return;
    const double range = (*polar)[0] + options_.sigma_range * normal();
    const double bearing = (*polar)[1] + options_.sigma_bearing * normal();
    const Eigen::Rotation2Dd turn(bearing);
    const double across = range * options_.sigma_bearing;
    const Eigen::Vector2d variances(options_.sigma_range * options_.sigma_range, across * across);
    seen.push_back(
        {turn * Eigen::Vector2d(range, 0.0),
         turn.toRotationMatrix() * variances.asDiagonal() * turn.toRotationMatrix().transpose()});
  }
  std::vector<PlanarPoint> look() {
    std::vector<PlanarPoint> seen;
    for (const auto& p : landmarks_) see(p, seen);
    for (const auto& p : objects_) see(p, seen);
    return seen;
  }
  void drive(RecentSightings& recent) {
    const double turn = options_.turn_sigma * normal();
    pose_.head<2>() +=
        options_.step_length * Eigen::Vector2d(std::cos(pose_[2]), std::sin(pose_[2]));
    pose_[2] = wrap_angle(pose_[2] + turn);
    const Eigen::Vector3d sigma(options_.sigma_forward, 0.25 * options_.sigma_forward,
                                options_.sigma_turn);
    const Eigen::Vector3d noise(normal(), normal(), normal());
    recent.move(Eigen::Vector3d(options_.step_length, 0.0, turn) + sigma.cwiseProduct(noise),
                sigma.cwiseAbs2().asDiagonal());
  }

  KidnapOptions options_;
  std::mt19937_64 random_;
  std::vector<Eigen::Vector2d> landmarks_, objects_;
  std::optional<ConstellationIndex> index_;
  Eigen::Vector2d least_, most_;
  Eigen::Vector3d pose_ = Eigen::Vector3d::Zero();  // the truth
};

/// Scattered uniformly over a square.
inline std::vector<Eigen::Vector2d> scattered(int landmarks, double side, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(0.0, side);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < landmarks; ++i) {
    const double x = place(random);
    points.emplace_back(x, place(random));
  }
  return points;
}

}  // namespace libslam::testing
