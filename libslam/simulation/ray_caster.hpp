#pragma once
// Distances to the nearest wall or trunk along a ray.
//
// Shapes lie in a uniform grid whose cells a ray visits in order (Amanatides and Woo, "A fast voxel
// traversal algorithm for ray tracing", Eurographics 1987), so that the cost of a ray depends on
// what is near it, not on the size of the world.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <libslam/simulation/world.hpp>

namespace libslam {

/// A round trunk, seen from outside.
struct Trunk {
  Eigen::Vector2d centre;  ///< [m]
  double radius = 0.0;     ///< [m]
};

class RayCaster {
 public:
  /// An empty world.
  RayCaster() = default;
  RayCaster(const std::vector<Wall>& walls, const std::vector<Trunk>& trunks);

  bool empty() const { return shapes_.empty(); }

  /// Distance from `origin` to the nearest shape along the unit vector `direction`, at most
  /// `max_range`; `max_range` where there is none [m].
  double cast(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
              double max_range) const;
  /// True if nothing stands between two points.
  bool sees(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

 private:
  /// A wall from `point` along `edge`, or, where `radius` > 0, a trunk about `point`.
  struct Shape {
    Eigen::Vector2d point, edge;
    double radius;
  };

  void build_grid();
  /// Calls `visit(cell)` for every cell that the bounding box of a shape meets.
  template <class Visit>
  void for_each_cell(const Shape& shape, Visit visit) const;
  std::int64_t cell_of(double coordinate, int axis) const;
  /// Narrows [enter, leave] to the part of the ray inside the grid; false if there is none.
  bool clip(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, double& enter,
            double& leave) const;
  double hit(const Shape& shape, const Eigen::Vector2d& origin,
             const Eigen::Vector2d& direction) const;

  std::vector<Shape> shapes_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero(), high_ = Eigen::Vector2d::Zero();
  double cell_ = 1.0;
  std::int64_t columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> first_;    ///< per cell its begin in members_, one more at the end
  std::vector<std::uint32_t> members_;  ///< shapes of all cells, one after another
};

}  // namespace libslam
