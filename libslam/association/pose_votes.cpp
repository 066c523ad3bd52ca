#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <libslam/association/pose_fit.hpp>
#include <libslam/association/pose_votes.hpp>
#include <libslam/state/block.hpp>

namespace libslam {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Standard deviations of a distance or a place that still agree.
constexpr double kSigmas = 3.0;
/// Two seen points give a direction if they are this many standard deviations apart.
constexpr double kLeastBaseline = 4.0;

/// Two seen points, and how well they fix a pose.
struct Baseline {
  std::size_t a, b;
  double share_a;                  // of the point between them that is known best
  double sigma_place, sigma_turn;  // of that point [m], of the heading [rad]
  std::span<const PointDistance> partners;
  double cost;  // poses to be tried, times the area in which others may vote by chance
};

/// Another seen point, from the best known place of the baseline.
struct Voter {
  Vector2d arm;
  double radius;  // within which it agrees [m]
};

class Ballot {
 public:
  Ballot(const ConstellationIndex& map, std::span<const PlanarPoint> seen, std::size_t required)
      : map_(map), seen_(seen), required_(required) {
    for (std::size_t i = 0; i < seen.size(); ++i)
      sigma_.push_back(std::hypot(std::sqrt(seen[i].cov.trace()), map.largest_sigma()));
  }

  std::vector<Baseline> baselines() const {
    std::vector<Baseline> result;
    for (std::size_t a = 0; a < seen_.size(); ++a)
      for (std::size_t b = a + 1; b < seen_.size(); ++b) append_baseline(a, b, result);
    std::sort(result.begin(), result.end(), [](const Baseline& x, const Baseline& y) {
      return std::tie(x.cost, x.a, x.b) < std::tie(y.cost, y.a, y.b);
    });
    return result;
  }

  void vote(const Baseline& baseline) {
    voters_.clear();
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (i == baseline.a || i == baseline.b) continue;
      const double radius = kSigmas * tolerance(baseline, i);
      voters_.push_back({seen_[i].position - best_known(baseline), radius});
    }
    std::sort(voters_.begin(), voters_.end(),
              [](const Voter& x, const Voter& y) { return x.radius < y.radius; });
    for (const PointDistance& partner : baseline.partners) {
      propose(baseline, partner.first, partner.second);
      propose(baseline, partner.second, partner.first);
    }
  }

  std::vector<PoseVote> result() {
    std::stable_sort(kept_.begin(), kept_.end(),
                     [](const PoseVote& a, const PoseVote& b) { return a.votes > b.votes; });
    return std::move(kept_);
  }

 private:
  void append_baseline(std::size_t a, std::size_t b, std::vector<Baseline>& out) const {
    const Vector2d d = seen_[b].position - seen_[a].position;
    const double length = d.norm();
    const double both = std::hypot(sigma_[a], sigma_[b]);
    if (length < kLeastBaseline * both) return;
    Baseline baseline{a, b, 0.0, 0.0, both / length, {}, 0.0};
    const double weight_a = 1.0 / (sigma_[a] * sigma_[a]), weight_b = 1.0 / (sigma_[b] * sigma_[b]);
    baseline.share_a = weight_a / (weight_a + weight_b);
    baseline.sigma_place = 1.0 / std::sqrt(weight_a + weight_b);
    const double along = d.dot((seen_[a].cov + seen_[b].cov) * d) / (length * length);
    const double reach = kSigmas * std::sqrt(along + 2.0 * std::pow(map_.largest_sigma(), 2));
    baseline.partners = map_.between(length - reach, length + reach);
    double area = 0.0;
    for (std::size_t i = 0; i < seen_.size(); ++i) area += std::pow(tolerance(baseline, i), 2);
    baseline.cost = static_cast<double>(2 * baseline.partners.size() + 1) * area;
    out.push_back(baseline);
  }

  Vector2d best_known(const Baseline& baseline) const {
    return baseline.share_a * seen_[baseline.a].position +
           (1.0 - baseline.share_a) * seen_[baseline.b].position;
  }
  /// Standard deviation of where a landmark is against where point i puts it.
  double tolerance(const Baseline& baseline, std::size_t i) const {
    const double arm = (seen_[i].position - best_known(baseline)).norm();
    return std::hypot(sigma_[i], baseline.sigma_place, baseline.sigma_turn * arm);
  }

  void propose(const Baseline& baseline, std::size_t landmark_a, std::size_t landmark_b) {
    const Vector2d& m_a = map_.points()[landmark_a].position;
    const Vector2d& m_b = map_.points()[landmark_b].position;
    const Vector2d there = m_b - m_a;
    const Vector2d here = seen_[baseline.b].position - seen_[baseline.a].position;
    Eigen::Matrix2d rotation;  // turns `here` into the direction of `there`
    const double c = here.dot(there), s = here.x() * there.y() - here.y() * there.x();
    rotation << c, -s, s, c;
    rotation /= std::hypot(c, s);
    const Vector2d anchor = baseline.share_a * m_a + (1.0 - baseline.share_a) * m_b;
    const std::size_t votes = count_votes(anchor, rotation);
    if (votes < required_) return;
    Vector3d pose;
    pose << anchor - rotation * best_known(baseline), std::atan2(s, c);
    const std::array<PointPair, 2> two{{{&seen_[baseline.a], &map_.points()[landmark_a]},
                                        {&seen_[baseline.b], &map_.points()[landmark_b]}}};
    keep({pose, fit_pose(two, pose).cov, votes}, baseline);
  }

  /// Gives up as soon as `required_` is out of reach.
  std::size_t count_votes(const Vector2d& anchor, const Eigen::Matrix2d& rotation) const {
    std::size_t votes = 2, left = voters_.size();
    for (const Voter& voter : voters_) {
      if (votes + left < required_) return 0;
      --left;
      const Vector2d place = anchor + rotation * voter.arm;
      bool found = false;
      map_.near(place, voter.radius, [&](std::size_t k) {
        found = found ||
                (map_.points()[k].position - place).squaredNorm() <= voter.radius * voter.radius;
      });
      if (found) ++votes;
    }
    return votes;
  }

  void keep(const PoseVote& vote, const Baseline& baseline) {
    for (PoseVote& other : kept_) {
      const double turn = wrap_angle(vote.T_world_robot[2] - other.T_world_robot[2]);
      const double shift = (vote.T_world_robot - other.T_world_robot).head<2>().norm();
      if (std::abs(turn) > kSigmas * baseline.sigma_turn ||
          shift > kSigmas * std::sqrt(vote.cov.topLeftCorner<2, 2>().trace()))
        continue;
      if (vote.votes > other.votes) other = vote;
      return;
    }
    if (kept_.size() < kMaxVotes) return kept_.push_back(vote);
    const auto least =
        std::min_element(kept_.begin(), kept_.end(),
                         [](const PoseVote& a, const PoseVote& b) { return a.votes < b.votes; });
    if (least->votes < vote.votes) *least = vote;
  }

  const ConstellationIndex& map_;
  std::span<const PlanarPoint> seen_;
  std::size_t required_;
  std::vector<double> sigma_;  // of seen point and landmark together
  std::vector<Voter> voters_;  // of the baseline that is voted on, the sharpest first
  std::vector<PoseVote> kept_;
};

}  // namespace

std::vector<PoseVote> vote_on_poses(const ConstellationIndex& map,
                                    std::span<const PlanarPoint> seen,
                                    const PoseVoteOptions& options) {
  std::vector<PlanarPoint> voters(seen.begin(), seen.end());
  std::stable_sort(voters.begin(), voters.end(), [](const PlanarPoint& a, const PlanarPoint& b) {
    return a.cov.trace() < b.cov.trace();
  });
  voters.resize(std::min(voters.size(), kMaxVoters));
  const double part = std::ceil(options.least_fraction * static_cast<double>(voters.size()));
  Ballot ballot(map, voters, std::max(options.least_votes, static_cast<std::size_t>(part)));
  std::size_t left = options.budget;
  for (const Baseline& baseline : ballot.baselines()) {
    const std::size_t poses = 2 * baseline.partners.size();
    if (poses > left) continue;
    left -= poses;
    ballot.vote(baseline);
  }
  return ballot.result();
}

}  // namespace libslam
