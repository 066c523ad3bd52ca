#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <libslam/result/metrics.hpp>
#include <libslam/result/spatial_alignment.hpp>

namespace libslam {
namespace {

using Eigen::Isometry3d;
using mrpt::math::TPose2D;

/// Positions with the ids they came with.
template <int Dimension>
struct Points {
  using Position = Eigen::Matrix<double, Dimension, 1>;
  std::vector<std::int64_t> ids;
  std::vector<Position> positions;

  /// Coordinates beyond those given are 0.
  void add(std::int64_t id, const Eigen::VectorXd& coordinates) {
    if (coordinates.size() < 2) return;
    const Eigen::Index given = std::min<Eigen::Index>(Dimension, coordinates.size());
    ids.push_back(id);
    positions.emplace_back(Position::Zero()).head(given) = coordinates.head(given);
  }
};

struct IndexPair {
  std::size_t estimate, truth;
};

Eigen::Vector2d transform(const TPose2D& T, const Eigen::Vector2d& point) {
  return transform_point(T, point);
}
Eigen::Vector3d transform(const Isometry3d& T, const Eigen::Vector3d& point) {
  return T * point;
}
std::optional<TPose2D> fit_columns(const Eigen::Matrix2Xd& estimate,
                                   const Eigen::Matrix2Xd& truth) {
  return fit_rigid(estimate, truth);
}
std::optional<Isometry3d> fit_columns(const Eigen::Matrix3Xd& estimate,
                                      const Eigen::Matrix3Xd& truth) {
  return fit_rigid_in_space(estimate, truth);
}

template <int Dimension>
std::vector<IndexPair> match_by_id(const Points<Dimension>& estimate,
                                   const Points<Dimension>& truth) {
  std::map<std::int64_t, std::size_t> index;
  for (std::size_t i = 0; i < truth.ids.size(); ++i) index.emplace(truth.ids[i], i);
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i < estimate.ids.size(); ++i)
    if (const auto found = index.find(estimate.ids[i]); found != index.end())
      pairs.push_back({i, found->second});
  return pairs;
}

template <typename Position>
std::size_t nearest(const Position& point, const std::vector<Position>& others) {
  std::size_t best = others.size();
  double best_square = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < others.size(); ++i)
    if (const double square = (others[i] - point).squaredNorm(); square < best_square) {
      best_square = square;
      best = i;
    }
  return best;
}

template <typename Position, typename Transform>
std::vector<IndexPair> match_mutually(std::vector<Position> estimate,
                                      const std::vector<Position>& truth,
                                      const Transform& placement) {
  for (Position& point : estimate) point = transform(placement, point);
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const std::size_t j = nearest(estimate[i], truth);
    if (j < truth.size() && nearest(truth[j], estimate) == i) pairs.push_back({i, j});
  }
  return pairs;
}

template <int Dimension>
double rmse(const Points<Dimension>& estimate, const Points<Dimension>& truth,
            const std::vector<IndexPair>& pairs, const auto& T) {
  double squares = 0.0;
  for (const IndexPair& p : pairs)
    squares +=
        (transform(T, estimate.positions[p.estimate]) - truth.positions[p.truth]).squaredNorm();
  return std::sqrt(squares / static_cast<double>(pairs.size()));
}

template <int Dimension>
auto fit(const Points<Dimension>& estimate, const Points<Dimension>& truth,
         const std::vector<IndexPair>& pairs) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::Matrix<double, Dimension, Eigen::Dynamic> from(Dimension, n), to(Dimension, n);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = estimate.positions[pairs[i].estimate];
    to.col(static_cast<Eigen::Index>(i)) = truth.positions[pairs[i].truth];
  }
  return fit_columns(from, to);
}

template <int Dimension, typename Transform>
std::optional<MapErrors> compare(const LandmarkMap& map, const std::vector<TrueLandmark>& truth,
                                 LandmarkIdentity identity,
                                 const std::optional<Transform>& placement, bool raw) {
  Points<Dimension> estimated, real;
  for (const LandmarkEstimate& landmark : map)
    if (landmark.type == "point") estimated.add(landmark.id, landmark.mean);
  for (const TrueLandmark& landmark : truth) real.add(landmark.id, landmark.position);
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

}  // namespace

std::optional<MapErrors> compare_map(const LandmarkMap& map, const std::vector<TrueLandmark>& truth,
                                     LandmarkIdentity identity,
                                     const std::optional<TPose2D>& placement, bool raw) {
  return compare<2>(map, truth, identity, placement, raw);
}

std::optional<MapErrors> compare_map_in_space(const LandmarkMap& map,
                                              const std::vector<TrueLandmark>& truth,
                                              LandmarkIdentity identity,
                                              const std::optional<Isometry3d>& placement,
                                              bool raw) {
  return compare<3>(map, truth, identity, placement, raw);
}

}  // namespace libslam
