#pragma once
// A small simulated world for tests of the whole filter: landmarks on a grid, a drive on a circle.

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/feature.hpp>
#include <libslam/data/motion_action.hpp>
#include <libslam/state/block.hpp>

namespace libslam::testing {

struct SlamWorld {
  std::vector<Eigen::Vector2d> landmarks;
  Eigen::Vector3d T_robot_sensor = Eigen::Vector3d(0.3, -0.2, 0.4);
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< true pose
  double sensor_range = 8.0;                       ///< [m]
  double sigma_range = 0.05, sigma_bearing = 0.01;
  double sigma_forward = 0.01, sigma_turn = 0.005;  ///< odometry noise per step
  double step_length = 0.5, step_turn = 0.05;

  explicit SlamWorld(int side = 6, double spacing = 4.0) {
    for (int i = 0; i < side; ++i)
      for (int k = 0; k < side; ++k)
        landmarks.emplace_back(spacing * (i - 0.5 * side), spacing * (k + 0.3 * (i % 2)) - spacing);
  }

  /// Drives one step and returns what the odometry says; noise scaled by `noise`.
  MotionAction drive(std::mt19937_64& random, double noise) {
    std::normal_distribution<double> normal;
    const Eigen::Vector3d increment = arc(step_length, step_turn);
    const double c = std::cos(pose[2]), s = std::sin(pose[2]);
    pose += Eigen::Vector3d(c * increment[0] - s * increment[1],
                            s * increment[0] + c * increment[1], increment[2]);
    pose[2] = wrap_angle(pose[2]);
    MotionAction action;
    action.dt = 0.1;
    const double forward = step_length + noise * sigma_forward * normal(random);
    const double turn = step_turn + noise * sigma_turn * normal(random);
    action.increment = arc(forward, turn);
    const Eigen::Matrix<double, 3, 2> g = (arc_jacobian(forward, turn));
    action.cov_increment =
        g * Eigen::Vector2d(sigma_forward * sigma_forward, sigma_turn * sigma_turn).asDiagonal() *
        g.transpose();
    return action;
  }

  /// What the sensor sees from the true pose, identities are positions in `landmarks`.
  std::vector<Feature> observe(std::mt19937_64& random, double noise) const {
    std::normal_distribution<double> normal;
    std::vector<Feature> features;
    const double heading = pose[2] + T_robot_sensor[2];
    const double c = std::cos(pose[2]), s = std::sin(pose[2]);
    const Eigen::Vector2d sensor =
        pose.head<2>() + Eigen::Vector2d(c * T_robot_sensor[0] - s * T_robot_sensor[1],
                                         s * T_robot_sensor[0] + c * T_robot_sensor[1]);
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      const Eigen::Vector2d d = landmarks[i] - sensor;
      if (d.norm() > sensor_range) continue;
      Feature& feature = features.emplace_back();
      feature.id = static_cast<std::int64_t>(i);
      feature.T_robot_sensor = T_robot_sensor;
      feature.cov =
          Eigen::Vector2d(sigma_range * sigma_range, sigma_bearing * sigma_bearing).asDiagonal();
      feature.z = Eigen::Vector2d(
          d.norm() + noise * sigma_range * normal(random),
          wrap_angle(std::atan2(d.y(), d.x()) - heading + noise * sigma_bearing * normal(random)));
    }
    return features;
  }

 private:
  static Eigen::Vector3d arc(double length, double turn) {
    const double half = 0.5 * turn;
    const double chord = std::abs(half) < 1e-9 ? length : length * std::sin(half) / half;
    return {chord * std::cos(half), chord * std::sin(half), turn};
  }
  static Eigen::Matrix<double, 3, 2> arc_jacobian(double length, double turn) {
    constexpr double kStep = 1e-6;
    Eigen::Matrix<double, 3, 2> g;
    g.col(0) = (arc(length + kStep, turn) - arc(length - kStep, turn)) / (2 * kStep);
    g.col(1) = (arc(length, turn + kStep) - arc(length, turn - kStep)) / (2 * kStep);
    return g;
  }
};

}  // namespace libslam::testing
