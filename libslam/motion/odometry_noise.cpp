#include <cmath>

#include <libslam/motion/odometry_noise.hpp>

namespace libslam {

NoiseVector OdometryNoise::variance(double dt, double distance, double turn) const {
  const auto& p = parameters_;
  const double metres = std::abs(distance);
  const double radians = std::abs(turn);
  const auto sum = [&](double per_s, double per_m, double per_rad) {
    return per_s * per_s * dt + per_m * per_m * metres + per_rad * per_rad * radians;
  };
  NoiseVector variance;
  variance[kAlong] = sum(p.along_per_sqrt_s, p.along_per_sqrt_m, p.along_per_sqrt_rad);
  variance[kAcross] = sum(p.across_per_sqrt_s, p.across_per_sqrt_m, 0.0);
  variance[kTurn] = sum(p.turn_per_sqrt_s, p.turn_per_sqrt_m, p.turn_per_sqrt_rad);
  variance[kSteering] = dt > 0.0 ? p.steering_per_sqrt_s * p.steering_per_sqrt_s / dt : 0.0;
  return variance;
}

}  // namespace libslam
