#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <libslam/simulation/ray_caster.hpp>

namespace libslam {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMostCells = 1 << 20;
// Two shapes for every cell that is not empty are a good trade in practice.
constexpr double kCellsPerShape = 4.0;
// Walls reach this part of their length further, so that no ray slips between two that meet.
constexpr double kOverlap = 1e-12;
// Hits nearer than this share of the distance belong to the target itself.
constexpr double kTargetItself = 1e-9;

}  // namespace

RayCaster::RayCaster(const std::vector<Wall>& walls, const std::vector<Trunk>& trunks) {
  for (const Wall& wall : walls) shapes_.push_back({wall.from, wall.to - wall.from, 0.0});
  for (const Trunk& trunk : trunks)
    if (trunk.radius > 0.0)
      shapes_.push_back({trunk.centre, Eigen::Vector2d::Zero(), trunk.radius});
  if (!shapes_.empty()) build_grid();
}

std::int64_t RayCaster::cell_of(double coordinate, int axis) const {
  const std::int64_t count = axis == 0 ? columns_ : rows_;
  return std::clamp(static_cast<std::int64_t>((coordinate - low_[axis]) / cell_), std::int64_t{0},
                    count - 1);
}

template <class Visit>
void RayCaster::for_each_cell(const Shape& shape, Visit visit) const {
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(shape.radius);
  const Eigen::Vector2d end = shape.point + shape.edge;
  const Eigen::Vector2d low = shape.point.cwiseMin(end) - margin;
  const Eigen::Vector2d high = shape.point.cwiseMax(end) + margin;
  for (std::int64_t row = cell_of(low.y(), 1); row <= cell_of(high.y(), 1); ++row)
    for (std::int64_t column = cell_of(low.x(), 0); column <= cell_of(high.x(), 0); ++column)
      visit(static_cast<std::size_t>(row * columns_ + column));
}

void RayCaster::build_grid() {
  low_.setConstant(kInfinity);
  high_.setConstant(-kInfinity);
  for (const Shape& shape : shapes_) {
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(shape.radius);
    const Eigen::Vector2d end = shape.point + shape.edge;
    low_ = low_.cwiseMin(shape.point.cwiseMin(end) - margin);
    high_ = high_.cwiseMax(shape.point.cwiseMax(end) + margin);
  }
  // Shapes on the border must lie inside for a ray that ends there.
  const double margin = 1e-6 * (1.0 + (high_ - low_).maxCoeff());
  low_.array() -= margin;
  high_.array() += margin;
  const Eigen::Vector2d extent = high_ - low_;
  const double cells =
      std::min(kMostCells, kCellsPerShape * static_cast<double>(shapes_.size()) + 16.0);
  // A long thin world is cut along its length alone.
  cell_ = std::max(std::sqrt(extent.prod() / cells), extent.maxCoeff() / cells);
  columns_ = static_cast<std::int64_t>(extent.x() / cell_) + 1;
  rows_ = static_cast<std::int64_t>(extent.y() / cell_) + 1;
  first_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const Shape& shape : shapes_)
    for_each_cell(shape, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  members_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t shape = 0; shape < shapes_.size(); ++shape)
    for_each_cell(shapes_[shape], [&](std::size_t cell) {
      members_[next[cell]++] = static_cast<std::uint32_t>(shape);
    });
}

double RayCaster::hit(const Shape& shape, const Eigen::Vector2d& origin,
                      const Eigen::Vector2d& direction) const {
  const Eigen::Vector2d d = shape.point - origin;
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  if (shape.radius > 0.0) {
    const double along = d.dot(direction), across = cross(direction, d);
    const double half = shape.radius * shape.radius - across * across;
    if (half < 0.0) return kInfinity;
    const double distance = along - std::sqrt(half);
    return distance >= 0.0 ? distance : kInfinity;
  }
  const double determinant = cross(direction, shape.edge);
  if (determinant == 0.0) return kInfinity;
  const double distance = cross(d, shape.edge) / determinant;
  const double part = cross(d, direction) / determinant;
  return distance >= 0.0 && std::abs(part - 0.5) <= 0.5 + kOverlap ? distance : kInfinity;
}

bool RayCaster::clip(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, double& enter,
                     double& leave) const {
  for (int axis = 0; axis < 2; ++axis) {
    if (direction[axis] == 0.0) {
      if (origin[axis] < low_[axis] || origin[axis] > high_[axis]) return false;
      continue;
    }
    const double a = (low_[axis] - origin[axis]) / direction[axis];
    const double b = (high_[axis] - origin[axis]) / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

double RayCaster::cast(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                       double max_range) const {
  double enter = 0.0, leave = max_range;
  if (empty() || !clip(origin, direction, enter, leave)) return max_range;
  std::array<std::int64_t, 2> cell{}, step{};
  std::array<double, 2> next{}, stride{};  // distance to the next border, and between two
  for (int i = 0; i < 2; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    cell[axis] = cell_of(origin[i] + enter * direction[i], i);
    step[axis] = direction[i] < 0.0 ? -1 : 1;
    const double border =
        low_[i] + cell_ * static_cast<double>(cell[axis] + (step[axis] > 0 ? 1 : 0));
    const bool moves = direction[i] != 0.0;
    next[axis] = moves ? (border - origin[i]) / direction[i] : kInfinity;
    stride[axis] = moves ? cell_ / std::abs(direction[i]) : kInfinity;
  }
  double nearest = max_range;
  while (cell[0] >= 0 && cell[0] < columns_ && cell[1] >= 0 && cell[1] < rows_) {
    const auto index = static_cast<std::size_t>(cell[1] * columns_ + cell[0]);
    for (std::uint32_t i = first_[index]; i < first_[index + 1]; ++i)
      nearest = std::min(nearest, hit(shapes_[members_[i]], origin, direction));
    const std::size_t axis = next[0] < next[1] ? 0 : 1;
    if (next[axis] >= std::min(nearest, leave)) break;
    next[axis] += stride[axis];
    cell[axis] += step[axis];
  }
  return nearest;
}

bool RayCaster::sees(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  const double distance = (to - from).norm();
  if (empty() || distance == 0.0) return true;
  return cast(from, (to - from) / distance, distance) >= distance * (1.0 - kTargetItself);
}

}  // namespace libslam
