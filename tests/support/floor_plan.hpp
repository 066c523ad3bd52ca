#pragma once
// Floor plans of straight walls and what a laser scanner sees of them.

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Core>

#include <libslam/state/planar_pose.hpp>

namespace libslam::testing {

struct FloorPlan {
  struct Wall {
    Eigen::Vector2d from, to;
  };
  std::vector<Wall> walls;

  void add_box(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    const Eigen::Vector2d b(high.x(), low.y()), d(low.x(), high.y());
    walls.push_back({low, b});
    walls.push_back({b, high});
    walls.push_back({high, d});
    walls.push_back({d, low});
  }

  /// Range along `bearing` [rad] from `origin` [m]; infinite without a wall there.
  double range(const Eigen::Vector2d& origin, double bearing) const {
    const Eigen::Vector2d ray(std::cos(bearing), std::sin(bearing));
    double nearest = std::numeric_limits<double>::infinity();
    for (const Wall& wall : walls) {
      const Eigen::Vector2d along = wall.to - wall.from, to = wall.from - origin;
      const double det = along.x() * ray.y() - along.y() * ray.x();
      if (std::abs(det) < 1e-12) continue;
      const double r = (along.x() * to.y() - along.y() * to.x()) / det;
      const double s = (ray.x() * to.y() - ray.y() * to.x()) / det;
      if (r > 0.0 && s >= 0.0 && s <= 1.0 && r < nearest) nearest = r;
    }
    return nearest;
  }

  /// The ends of 181 beams over 180 degrees, within 12 m, in the frame of the robot.
  std::vector<Eigen::Vector2d> scan(const Eigen::Vector3d& T_world_robot, double sigma,
                                    std::mt19937_64& random) const {
    std::normal_distribution<double> normal;
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i <= 180; ++i) {
      const double bearing = to_radians(i - 90.0);
      const double r = range(T_world_robot.head<2>(), T_world_robot.z() + bearing);
      if (r > 12.0) continue;
      const double seen = r + sigma * normal(random);
      points.emplace_back(seen * std::cos(bearing), seen * std::sin(bearing));
    }
    return points;
  }
};

/// A square corridor of 24 m x 18 m around a block, 2 m wide, with cupboards at random places along
/// all of its walls.
inline FloorPlan ring_corridor(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  FloorPlan plan;
  plan.add_box({-1, -1}, {25, 19});
  plan.add_box({1, 1}, {23, 17});
  for (double x = 1.5; x < 22.0; x += 1.5 + 2.0 * uniform(random)) {
    const double deep = 0.2 + 0.4 * uniform(random), wide = 0.4 + 0.8 * uniform(random);
    plan.add_box({x, -1}, {x + wide, -1 + deep});
    plan.add_box({x + 0.7, 19 - deep}, {x + 0.7 + wide, 19});
  }
  for (double y = 1.5; y < 16.0; y += 1.5 + 2.0 * uniform(random)) {
    const double deep = 0.2 + 0.4 * uniform(random), wide = 0.4 + 0.8 * uniform(random);
    plan.add_box({-1, y}, {-1 + deep, y + wide});
    plan.add_box({25 - deep, y + 0.7}, {25, y + 0.7 + wide});
  }
  return plan;
}

}  // namespace libslam::testing
