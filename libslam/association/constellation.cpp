#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <libslam/association/constellation.hpp>
#include <libslam/association/pose_fit.hpp>
#include <libslam/association/pose_votes.hpp>
#include <libslam/state/block.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Pairs are looked for again after each fit; the third time nothing changes any more.
constexpr int kRounds = 3;
/// Poses are the same if their difference is within this chi-square probability.
constexpr double kSamePose = 0.9999;
/// Landmarks this near the border of a view, as a part of range and aperture, may be out of it.
constexpr double kBorder = 0.05;

struct Solution {
  PoseFit fit;
  std::vector<Pairing> pairs;
  std::size_t missed = 0;
  double log_odds = 0.0;  // against "not in the map"
};

/// Pairs, fits and weighs one pose.
class Solver {
 public:
  Solver(const ConstellationIndex& map, std::span<const PlanarPoint> seen,
         std::span<const SensorView> views, const ConstellationOptions& options)
      : map_(map),
        seen_(seen),
        views_(views),
        options_(options),
        gate_(chi_square_quantile(options.pair_probability, 2)),
        unmapped_density_(options.unmapped_density_ratio * map.density()) {}

  std::optional<Solution> solve(const PoseVote& vote) {
    Solution solution;
    solution.fit.T_world_robot = vote.T_world_robot;
    solution.fit.cov = vote.cov;
    for (int round = 0; round < kRounds; ++round) {
      pair_up(solution);
      if (solution.pairs.size() < options_.least_pairs) return std::nullopt;
      point_pairs_.clear();
      for (const Pairing& pair : solution.pairs)
        point_pairs_.push_back({&seen_[pair.feature], &map_.points()[pair.landmark]});
      solution.fit = fit_pose(point_pairs_, solution.fit.T_world_robot);
      if (!solution.fit.cov.allFinite()) return std::nullopt;
    }
    weigh(solution);
    return solution;
  }

 private:
  struct Choice {
    double cost;
    Pairing pair;
  };

  /// Greedily by d^2 + log|S|, the uncertainty of the pose included.
  void pair_up(Solution& solution) {
    const Vector3d& pose = solution.fit.T_world_robot;
    const Matrix2d rotation = rotation_of(pose);
    choices_.clear();
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const Vector2d arm = rotation * seen_[i].position;
      Eigen::Matrix<double, 2, 3> jacobian;
      jacobian << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
      const Matrix2d cov_pose = jacobian * solution.fit.cov * jacobian.transpose();
      const double variance =
          cov_pose.trace() + seen_[i].cov.trace() + map_.largest_sigma() * map_.largest_sigma();
      map_.near(pose.head<2>() + arm, std::sqrt(gate_ * variance), [&](std::size_t k) {
        PointResidual residual(seen_[i], map_.points()[k], pose, rotation);
        residual.s += cov_pose;
        const double distance2 = residual.mahalanobis2();
        if (distance2 <= gate_)
          choices_.push_back({distance2 + std::log(residual.s.determinant()), {i, k}});
      });
    }
    std::sort(choices_.begin(), choices_.end(), [](const Choice& a, const Choice& b) {
      return std::tie(a.cost, a.pair.feature, a.pair.landmark) <
             std::tie(b.cost, b.pair.feature, b.pair.landmark);
    });
    solution.pairs.clear();
    seen_taken_.assign(seen_.size(), false);
    landmark_taken_.assign(map_.points().size(), false);
    for (const auto& [cost, pair] : choices_) {
      if (seen_taken_[pair.feature] || landmark_taken_[pair.landmark]) continue;
      seen_taken_[pair.feature] = landmark_taken_[pair.landmark] = true;
      solution.pairs.push_back(pair);
    }
  }

  void weigh(Solution& solution) {
    solution.missed = count_missed(solution);
    const double p = options_.detection_probability;
    const double pairs = static_cast<double>(solution.pairs.size());
    const double two_pi = 2.0 * std::numbers::pi;
    solution.log_odds = 0.5 * std::log(std::pow(two_pi, 3) * solution.fit.cov.determinant()) -
                        std::log(two_pi * map_.area()) + solution.fit.log_likelihood +
                        pairs * std::log(p / unmapped_density_) +
                        static_cast<double>(solution.missed) * std::log(1.0 - p);
  }

  /// landmark_taken_ belongs to the solution.
  std::size_t count_missed(const Solution& solution) {
    const Vector3d& pose = solution.fit.T_world_robot;
    const Matrix2d rotation = rotation_of(pose);
    std::size_t missed = 0;
    for (const SensorView& view : views_) {
      const Vector2d place = pose.head<2>() + rotation * view.T_robot_sensor.head<2>();
      const double range = (1.0 - kBorder) * view.max_range;
      const double half_aperture = 0.5 * (1.0 - kBorder) * view.field_of_view;
      const double heading = pose[2] + view.T_robot_sensor[2];
      map_.near(place, range, [&](std::size_t k) {
        if (landmark_taken_[k]) return;
        const Vector2d d = map_.points()[k].position - place;
        if (d.squaredNorm() > range * range ||
            std::abs(wrap_angle(std::atan2(d.y(), d.x()) - heading)) > half_aperture)
          return;
        landmark_taken_[k] = true;  // counts once
        ++missed;
      });
    }
    return missed;
  }

  const ConstellationIndex& map_;
  std::span<const PlanarPoint> seen_;
  std::span<const SensorView> views_;
  const ConstellationOptions& options_;
  double gate_, unmapped_density_;
  std::vector<Choice> choices_;
  std::vector<PointPair> point_pairs_;
  std::vector<bool> seen_taken_, landmark_taken_;
};

/// Poses that agree, or that have most pairs in common: two points fix a pose, so that these differ
/// in the partners of some points, not in the place.
bool same_place(const Solution& a, const Solution& b) {
  static const double kGate = chi_square_quantile(kSamePose, 3);
  const auto common = std::count_if(a.pairs.begin(), a.pairs.end(), [&b](const Pairing& pair) {
    return std::find(b.pairs.begin(), b.pairs.end(), pair) != b.pairs.end();
  });
  if (2 * static_cast<std::size_t>(common) > std::max(a.pairs.size(), b.pairs.size())) return true;
  Vector3d difference = a.fit.T_world_robot - b.fit.T_world_robot;
  difference[2] = wrap_angle(difference[2]);
  return difference.dot((a.fit.cov + b.fit.cov).inverse() * difference) <= kGate;
}

/// Of the best solution: log of its posterior over that of all other poses and of none.
double odds_of_best(const std::vector<Solution>& solutions) {
  const Solution& best = solutions.front();
  double others = 1.0;  // not in the map
  for (std::size_t i = 1; i < solutions.size(); ++i) {
    const auto earlier = solutions.begin() + static_cast<std::ptrdiff_t>(i);
    const bool counted = std::any_of(solutions.begin(), earlier, [&](const Solution& other) {
      return same_place(other, solutions[i]);
    });
    if (!counted) others += std::exp(std::min(solutions[i].log_odds, 700.0));
  }
  return best.log_odds - std::log(others);
}

}  // namespace

ConstellationMatch match_constellation(const ConstellationIndex& map,
                                       std::span<const PlanarPoint> seen,
                                       std::span<const SensorView> views,
                                       const ConstellationOptions& options) {
  ConstellationMatch match;
  const auto fraction = options.least_paired_fraction * static_cast<double>(seen.size());
  const std::size_t required =
      std::max(options.least_pairs, static_cast<std::size_t>(std::ceil(fraction)));
  if (seen.size() < required || map.points().size() < required) return match;
  Solver solver(map, seen, views, options);
  std::vector<Solution> solutions;
  for (const PoseVote& vote : vote_on_poses(
           map, seen, {options.least_pairs, options.least_paired_fraction, options.budget}))
    if (auto solution = solver.solve(vote); solution && solution->pairs.size() >= required)
      solutions.push_back(std::move(*solution));
  if (solutions.empty()) return match;
  std::stable_sort(solutions.begin(), solutions.end(),
                   [](const Solution& a, const Solution& b) { return a.log_odds > b.log_odds; });
  Solution& best = solutions.front();
  match.log_odds = odds_of_best(solutions);
  match.T_world_robot = best.fit.T_world_robot;
  match.cov = best.fit.cov;
  match.mahalanobis2 = best.fit.mahalanobis2;
  match.missed = best.missed;
  match.pairs = std::move(best.pairs);
  const int dof = 2 * static_cast<int>(match.pairs.size()) - 3;
  if (match.mahalanobis2 > chi_square_quantile(options.fit_probability, dof))
    match.verdict = ConstellationVerdict::kMisfit;
  else if (match.log_odds < options.least_log_odds)
    match.verdict = ConstellationVerdict::kAmbiguous;
  else
    match.verdict = ConstellationVerdict::kFound;
  return match;
}

}  // namespace libslam
