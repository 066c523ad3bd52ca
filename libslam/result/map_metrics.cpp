#include <cmath>
#include <limits>

#include <libslam/result/metrics.hpp>

namespace libslam {
namespace {

/// Positions in the plane with the ids they came with.
struct Points {
  std::vector<std::int64_t> ids;
  std::vector<Eigen::Vector2d> positions;
};

struct IndexPair {
  std::size_t estimate, truth;
};

std::vector<IndexPair> match_by_id(const Points& estimate, const Points& truth) {
  std::map<std::int64_t, std::size_t> index;
  for (std::size_t i = 0; i < truth.ids.size(); ++i) index.emplace(truth.ids[i], i);
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i < estimate.ids.size(); ++i)
    if (const auto found = index.find(estimate.ids[i]); found != index.end())
      pairs.push_back({i, found->second});
  return pairs;
}

std::size_t nearest(const Eigen::Vector2d& point, const std::vector<Eigen::Vector2d>& others) {
  std::size_t best = others.size();
  double best_square = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < others.size(); ++i)
    if (const double square = (others[i] - point).squaredNorm(); square < best_square) {
      best_square = square;
      best = i;
    }
  return best;
}

std::vector<IndexPair> match_mutually(std::vector<Eigen::Vector2d> estimate,
                                      const std::vector<Eigen::Vector2d>& truth,
                                      const mrpt::math::TPose2D& placement) {
  for (Eigen::Vector2d& point : estimate) point = transform_point(placement, point);
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const std::size_t j = nearest(estimate[i], truth);
    if (j < truth.size() && nearest(truth[j], estimate) == i) pairs.push_back({i, j});
  }
  return pairs;
}

double rmse(const Points& estimate, const Points& truth, const std::vector<IndexPair>& pairs,
            const mrpt::math::TPose2D& T) {
  double squares = 0.0;
  for (const IndexPair& p : pairs)
    squares += (transform_point(T, estimate.positions[p.estimate]) - truth.positions[p.truth])
                   .squaredNorm();
  return std::sqrt(squares / static_cast<double>(pairs.size()));
}

std::optional<mrpt::math::TPose2D> fit(const Points& estimate, const Points& truth,
                                       const std::vector<IndexPair>& pairs) {
  Eigen::Matrix2Xd from(2, static_cast<Eigen::Index>(pairs.size())), to(2, from.cols());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = estimate.positions[pairs[i].estimate];
    to.col(static_cast<Eigen::Index>(i)) = truth.positions[pairs[i].truth];
  }
  return fit_rigid(from, to);
}

}  // namespace

std::optional<MapErrors> compare_map(const LandmarkMap& map, const std::vector<TrueLandmark>& truth,
                                     LandmarkIdentity identity,
                                     const std::optional<mrpt::math::TPose2D>& placement,
                                     bool raw) {
  Points estimated, real;
  for (const LandmarkEstimate& landmark : map)
    if (landmark.type == "point" && landmark.mean.size() >= 2) {
      estimated.ids.push_back(landmark.id);
      estimated.positions.emplace_back(landmark.mean.head<2>());
    }
  for (const TrueLandmark& landmark : truth)
    if (landmark.position.size() >= 2) {
      real.ids.push_back(landmark.id);
      real.positions.emplace_back(landmark.position.head<2>());
    }
  if (estimated.ids.empty() || (identity == LandmarkIdentity::unknown && !placement))
    return std::nullopt;
  const std::vector<IndexPair> pairs =
      identity == LandmarkIdentity::known
          ? match_by_id(estimated, real)
          : match_mutually(estimated.positions, real.positions, *placement);
  MapErrors errors;
  errors.matched = static_cast<int>(pairs.size());
  errors.missed = static_cast<int>(real.ids.size()) - errors.matched;
  errors.duplicates = static_cast<int>(estimated.ids.size()) - errors.matched;
  if (pairs.empty()) return errors;
  if (raw && placement) errors.rmse_m = rmse(estimated, real, pairs, *placement);
  if (const auto T = fit(estimated, real, pairs))
    errors.rmse_aligned_m = rmse(estimated, real, pairs, *T);
  return errors;
}

}  // namespace libslam
