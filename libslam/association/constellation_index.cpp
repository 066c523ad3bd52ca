#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include <libslam/association/constellation_index.hpp>

namespace libslam {

ConstellationIndex::ConstellationIndex(std::vector<PlanarPoint> points, double max_distance,
                                       double margin)
    : points_(std::move(points)) {
  if (!(max_distance > 0.0 && margin > 0.0))
    throw std::invalid_argument("the distance and the margin of a constellation must be positive");
  if (points_.empty()) {
    cell_start_.assign(2, 0);
    return;
  }
  Eigen::Vector2d least = points_.front().position, most = least;
  for (const PlanarPoint& point : points_) {
    if (!point.position.allFinite() || !point.cov.allFinite())
      throw std::invalid_argument("a point of the constellation is not finite");
    least = least.cwiseMin(point.position);
    most = most.cwiseMax(point.position);
    largest_sigma_ = std::max(largest_sigma_, std::sqrt(std::max(0.0, point.cov.trace())));
  }
  const Eigen::Vector2d extent = most - least;
  // Points on a line have no area; the margin keeps the density finite.
  const Eigen::Vector2d with_margin = extent.array() + 2.0 * margin;
  area_ = with_margin.prod();
  density_ = static_cast<double>(points_.size()) / (extent.array() + margin).prod();
  origin_ = least;
  const double side = std::sqrt(extent.prod() / static_cast<double>(points_.size()));
  cell_ = std::max(side, extent.maxCoeff() / 512.0);
  if (!(cell_ > 0.0)) cell_ = 1.0;
  columns_ = static_cast<int>(extent.x() / cell_) + 1;
  rows_ = static_cast<int>(extent.y() / cell_) + 1;
  build_cells();
  for (std::uint32_t i = 0; i < points_.size(); ++i)
    for (std::uint32_t k = i + 1; k < points_.size(); ++k) {
      const double distance = (points_[i].position - points_[k].position).norm();
      if (distance <= max_distance) distances_.push_back({static_cast<float>(distance), i, k});
    }
  std::sort(distances_.begin(), distances_.end(), [](const auto& a, const auto& b) {
    return std::tie(a.distance, a.first, a.second) < std::tie(b.distance, b.first, b.second);
  });
  if (distances_.size() > kMaxDistances) distances_.resize(kMaxDistances);
}

int ConstellationIndex::column(double x) const {
  return static_cast<int>(std::clamp((x - origin_.x()) / cell_, 0.0, columns_ - 1.0));
}

int ConstellationIndex::row(double y) const {
  return static_cast<int>(std::clamp((y - origin_.y()) / cell_, 0.0, rows_ - 1.0));
}

void ConstellationIndex::build_cells() {
  const auto cell_of = [this](const PlanarPoint& point) {
    return static_cast<std::size_t>(row(point.position.y()) * columns_ +
                                    column(point.position.x()));
  };
  cell_start_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const PlanarPoint& point : points_) ++cell_start_[cell_of(point) + 1];
  for (std::size_t i = 1; i < cell_start_.size(); ++i) cell_start_[i] += cell_start_[i - 1];
  std::vector<std::uint32_t> next(cell_start_.begin(), cell_start_.end() - 1);
  cell_points_.resize(points_.size());
  for (std::uint32_t i = 0; i < points_.size(); ++i) cell_points_[next[cell_of(points_[i])]++] = i;
}

std::span<const PointDistance> ConstellationIndex::between(double least, double most) const {
  const auto first = std::lower_bound(
      distances_.begin(), distances_.end(), least,
      [](const PointDistance& pair, double distance) { return pair.distance < distance; });
  const auto last = std::upper_bound(
      first, distances_.end(), most,
      [](double distance, const PointDistance& pair) { return distance < pair.distance; });
  return {first, last};
}

}  // namespace libslam
