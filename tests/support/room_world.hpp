#pragma once
// A room of straight walls for tests with lines: a robot drives on a circle and sees every wall
// that faces it.

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <libslam/data/feature.hpp>
#include <libslam/data/motion_action.hpp>
#include <libslam/state/block.hpp>

namespace libslam::testing {

struct Wall {
  Eigen::Vector2d from, to;
};

struct RoomWorld {
  static constexpr double kNearest = 0.2;  ///< distance from which a wall is seen [m]
  /// A polygon with oblique walls, a block inside it, and the far walls of a corridor. A wall is
  /// seen from the left of its way, `from` to `to`, alone.
  std::vector<Wall> walls{{{-6, -5}, {7, -5}}, {{7, -5}, {7, 4}},     {{7, 4}, {1, 8}},
                          {{1, 8}, {-6, 6}},   {{-6, 6}, {-6, -5}},   {{-1, 0.5}, {-1, 1.5}},
                          {{-1, 1.5}, {1, 2}}, {{40, -20}, {40, 30}}, {{30, 33}, {-20, 35}}};
  Eigen::Vector3d T_robot_sensor = Eigen::Vector3d(0.3, -0.2, 0.4);
  Eigen::Vector3d pose = Eigen::Vector3d(2, -2, 0.1);  ///< true pose
  double sigma_alpha = 0.01, sigma_r = 0.03;
  double sigma_forward = 0.01, sigma_turn = 0.005;  ///< odometry noise per step

  Eigen::Vector2d sensor_position() const {
    return pose.head<2>() + Eigen::Rotation2Dd(pose[2]) * Eigen::Vector2d(T_robot_sensor.head<2>());
  }

  void move(const Eigen::Vector3d& increment) {
    pose.head<2>() += Eigen::Rotation2Dd(pose[2]) * Eigen::Vector2d(increment.head<2>());
    pose[2] = wrap_angle(pose[2] + increment[2]);
  }

  /// Drives one step and returns what the odometry says; noise scaled by `noise`.
  MotionAction drive(std::mt19937_64& random, double noise) {
    std::normal_distribution<double> normal;
    const Eigen::Vector3d increment(0.3, 0.0, 0.06);
    move(increment);
    MotionAction action;
    action.dt = 0.1;
    action.increment = increment + noise * Eigen::Vector3d(sigma_forward * normal(random), 0.0,
                                                           sigma_turn * normal(random));
    const double rest = 1e-3 * sigma_forward;
    action.cov_increment =
        Eigen::Vector3d(sigma_forward, rest, sigma_turn).cwiseAbs2().asDiagonal();
    return action;
  }

  /// The walls from the true pose; identities are positions in `walls`.
  std::vector<Feature> observe(std::mt19937_64& random, double noise) const {
    std::normal_distribution<double> normal;
    std::vector<Feature> features;
    const Eigen::Rotation2Dd R_sensor_world(-pose[2] - T_robot_sensor[2]);
    for (std::size_t i = 0; i < walls.size(); ++i) {
      const Eigen::Vector2d from = R_sensor_world * (walls[i].from - sensor_position());
      const Eigen::Vector2d to = R_sensor_world * (walls[i].to - sensor_position());
      const Eigen::Vector2d along = (to - from).normalized();
      const Eigen::Vector2d n(along.y(), -along.x());
      if (n.dot(from) < kNearest) continue;
      const Eigen::Vector2d left(-n.y(), n.x());
      Feature& feature = features.emplace_back();
      feature.id = static_cast<std::int64_t>(i);
      feature.T_robot_sensor = T_robot_sensor;
      feature.cov = Eigen::Vector2d(sigma_alpha, sigma_r).cwiseAbs2().asDiagonal();
      feature.z = Eigen::Vector2d(
          wrap_angle(std::atan2(n.y(), n.x()) + noise * sigma_alpha * normal(random)),
          n.dot(from) + noise * sigma_r * normal(random));
      const double a = left.dot(from), b = left.dot(to);
      feature.extent = Extent{std::min(a, b), std::max(a, b), 0.01, 0.01};
    }
    return features;
  }
};

}  // namespace libslam::testing
