#pragma once
// A planar map of points, searchable by place and by the distance of two points.

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace libslam {

struct PlanarPoint {
  Eigen::Vector2d position;  ///< [m]
  Eigen::Matrix2d cov;       ///< [m^2]
};

/// Two points of the map and how far they are apart.
struct PointDistance {
  float distance;  ///< [m]
  std::uint32_t first, second;
};

/// Built once per map: O(n^2 log n) time and memory of the pairs that are not farther apart than
/// `max_distance`, the nearest `kMaxDistances` of them.
class ConstellationIndex {
 public:
  static constexpr std::size_t kMaxDistances = 2'000'000;

  /// `max_distance`: of two points that can be seen together [m]; `margin`: how far from the
  /// nearest corner of the map the robot may be [m]. Throws std::invalid_argument unless positive,
  /// or if a point is not finite.
  ConstellationIndex(std::vector<PlanarPoint> points, double max_distance, double margin);

  std::span<const PlanarPoint> points() const { return points_; }
  /// Those with `least` <= distance <= `most`, nearest first.
  std::span<const PointDistance> between(double least, double most) const;
  /// Calls visit(k) for every point that may be within `radius` of `place`, and some others.
  template <class Visit>
  void near(const Eigen::Vector2d& place, double radius, Visit visit) const;

  double area() const { return area_; }        ///< of the bounding box with the margin [m^2]
  double density() const { return density_; }  ///< points per square metre of the bounding box
  double largest_sigma() const { return largest_sigma_; }  ///< of all points [m]

 private:
  int column(double x) const;
  int row(double y) const;
  void build_cells();

  std::vector<PlanarPoint> points_;
  std::vector<PointDistance> distances_;
  std::vector<std::uint32_t> cell_start_, cell_points_;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  double cell_ = 1.0, area_ = 1.0, density_ = 1.0, largest_sigma_ = 0.0;
  int columns_ = 1, rows_ = 1;
};

template <class Visit>
void ConstellationIndex::near(const Eigen::Vector2d& place, double radius, Visit visit) const {
  const int first_column = column(place.x() - radius), last_column = column(place.x() + radius);
  const int last_row = row(place.y() + radius);
  for (int r = row(place.y() - radius); r <= last_row; ++r)
    for (int c = first_column; c <= last_column; ++c) {
      const auto cell = static_cast<std::size_t>(r * columns_ + c);
      for (std::uint32_t i = cell_start_[cell]; i < cell_start_[cell + 1]; ++i)
        visit(static_cast<std::size_t>(cell_points_[i]));
    }
}

}  // namespace libslam
