#pragma once
// Odometry and sensor parameters as state.

#include <libslam/config/description.hpp>

namespace libslam {

/// One calibration parameter of the state.
struct CalibrationParameter {
  bool enabled = false;
  double prior_mean = 1.0;
  double prior_sigma = 0.1;
  double random_walk_per_sqrt_s = 0.0;

  void describe(auto& v) {
    v.value("enabled", enabled, {"", "Estimate this parameter as a block of the state."});
    v.value("prior_mean", prior_mean,
            {"", "Value before any data; used as a constant when not enabled."});
    v.value("prior_sigma", prior_sigma, {"", "Standard deviation of the prior.", 1e-12});
    v.value("random_walk_per_sqrt_s", random_walk_per_sqrt_s,
            {"1/sqrt(s)", "Random walk of the parameter.", 0});
  }
};

/// Section `calibration`: odometry parameters (bias_turn: turn per metre driven [rad/m]), gyro
/// biases [rad/s], and the pose (x, y [m], phi [rad]) of a sensor that measures displacements, as
/// state.
struct CalibrationParameters {
  CalibrationParameter scale_left, scale_right;
  CalibrationParameter track_width{false, 1.0, 0.1, 0.0};
  CalibrationParameter scale_speed, scale_steering;
  CalibrationParameter bias_steering{false, 0.0, 0.02, 0.0};
  CalibrationParameter scale_turn;
  CalibrationParameter bias_turn{false, 0.0, 0.1, 0.0};
  CalibrationParameter bias_gyro_x{false, 0.0, 0.01, 0.0}, bias_gyro_y{false, 0.0, 0.01, 0.0};
  CalibrationParameter bias_gyro_z{false, 0.0, 0.01, 0.0};
  CalibrationParameter sensor_x{false, 0.0, 0.05, 0.0}, sensor_y{false, 0.0, 0.05, 0.0};
  CalibrationParameter sensor_phi{false, 0.0, 0.1, 0.0};

  void describe(auto& v) {
    v.section("scale_left", scale_left);
    v.section("scale_right", scale_right);
    v.section("track_width", track_width);
    v.section("scale_speed", scale_speed);
    v.section("scale_steering", scale_steering);
    v.section("bias_steering", bias_steering);
    v.section("scale_turn", scale_turn);
    v.section("bias_turn", bias_turn);
    v.section("bias_gyro_x", bias_gyro_x);
    v.section("bias_gyro_y", bias_gyro_y);
    v.section("bias_gyro_z", bias_gyro_z);
    v.section("sensor_x", sensor_x);
    v.section("sensor_y", sensor_y);
    v.section("sensor_phi", sensor_phi);
  }
};

}  // namespace libslam
