#include <cmath>
#include <random>

#include <libslam/simulation/random_stream.hpp>
#include <libslam/simulation/vehicle_faults.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

namespace {

// A slip of n periods takes n periods, whatever n * dt rounds to.
constexpr double kRounding = 1e-9;

}  // namespace

void VehicleFaults::advance_slip(std::int64_t tick, double dt) {
  if (slip_left_s_ > 0.0) {
    slip_left_s_ -= dt;
    if (slip_left_s_ > kRounding) return;
    slip_left_s_ = 0.0;
  }
  RandomStream random(seed_, RandomPurpose::kSlip, static_cast<std::uint64_t>(tick));
  std::uniform_real_distribution<double> uniform;
  if (uniform(random) >= -std::expm1(-slip_.rate_per_s * dt)) return;
  slip_left_s_ = slip_.duration_s;
  slip_side_ = uniform(random) < 0.5 ? -1.0 : 1.0;
}

Eigen::Vector3d VehicleFaults::disturb(const Eigen::Vector3d& before, const Eigen::Vector3d& after,
                                       std::int64_t tick, double elapsed, double dt) {
  Eigen::Vector3d pose = after;
  if (slip_.enabled) advance_slip(tick, dt);
  if (slipping()) {
    Eigen::Vector3d increment = relative_pose(before, after);
    increment.head<2>() *= slip_.travel_factor;
    increment.z() += slip_side_ * to_radians(slip_.turn_rate_deg_s) * dt;
    pose = compose_poses(before, increment);
  }
  if (kidnap_.enabled && !kidnapped_ && elapsed >= kidnap_.time_s) {
    kidnapped_ = true;
    pose = compose_poses(pose, {kidnap_.forward, kidnap_.left, to_radians(kidnap_.turn_deg)});
  }
  return pose;
}

}  // namespace libslam
