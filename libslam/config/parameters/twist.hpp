#pragma once
// Motion in space from body velocities.

#include <libslam/config/description.hpp>

namespace libslam {

/// Noise of a body velocity. A reading is wrong by one draw for as long as it holds, T seconds:
/// over a part dt of them its displacement has the variance sigma^2 T dt, so that the parts of a
/// reading add up to (sigma T)^2 however it is cut. White noise between readings goes by its
/// density.
struct TwistParameters {
  double sigma_speed_x = 0.1, sigma_speed_y = 0.1, sigma_speed_z = 0.1;
  double sigma_rate_x = 0.01, sigma_rate_y = 0.01, sigma_rate_z = 0.01;
  double speed_per_sqrt_s = 0.0;
  double rate_per_sqrt_s = 0.0;

  void describe(auto& v) {
    v.value("sigma_speed_x", sigma_speed_x,
            {"m/s", "Standard deviation of the forward velocity of one reading.", 0});
    v.value("sigma_speed_y", sigma_speed_y,
            {"m/s", "Standard deviation of the leftward velocity of one reading.", 0});
    v.value("sigma_speed_z", sigma_speed_z,
            {"m/s", "Standard deviation of the upward velocity of one reading.", 0});
    v.value("sigma_rate_x", sigma_rate_x,
            {"rad/s", "Standard deviation of the turn rate about x of one reading.", 0});
    v.value("sigma_rate_y", sigma_rate_y,
            {"rad/s", "Standard deviation of the turn rate about y of one reading.", 0});
    v.value("sigma_rate_z", sigma_rate_z,
            {"rad/s", "Standard deviation of the turn rate about z of one reading.", 0});
    v.value("speed_per_sqrt_s", speed_per_sqrt_s,
            {"m/sqrt(s)", "White noise of the velocity along each axis, as a density.", 0});
    v.value("rate_per_sqrt_s", rate_per_sqrt_s,
            {"rad/sqrt(s)", "White noise of the turn rate about each axis, as a density.", 0});
  }
};

/// A body that keeps its velocity: what a camera does that nothing else measures.
struct ConstantTwistParameters {
  double sigma_speed = 1.0;
  double sigma_rate = 0.2;
  double speed_walk_per_sqrt_s = 1.0;
  double rate_walk_per_sqrt_s = 0.3;

  void describe(auto& v) {
    v.value("sigma_speed", sigma_speed,
            {"m/s", "Standard deviation of the velocity along each axis at the start.", 1e-9});
    v.value("sigma_rate", sigma_rate,
            {"rad/s", "Standard deviation of the turn rate about each axis at the start.", 1e-9});
    v.value("speed_walk_per_sqrt_s", speed_walk_per_sqrt_s,
            {"m/s/sqrt(s)", "Random walk of the velocity along each axis.", 0});
    v.value("rate_walk_per_sqrt_s", rate_walk_per_sqrt_s,
            {"rad/s/sqrt(s)", "Random walk of the turn rate about each axis.", 0});
  }
};

}  // namespace libslam
