#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <libslam/simulation/way_point_driver.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

WayPointDriver::WayPointDriver(const DriveParameters& drive, const MotionParameters& motion,
                               std::vector<Eigen::Vector2d> way_points)
    : drive_(drive),
      steers_(motion.model == "ackermann"),
      wheelbase_(motion.wheelbase),
      way_points_(std::move(way_points)) {
  if (way_points_.empty()) throw std::invalid_argument("a world without way-points has no way");
}

bool WayPointDriver::arrive(const Eigen::Vector3d& T_world_robot) {
  while (reached_ < total() &&
         (target() - T_world_robot.head<2>()).norm() < drive_.way_point_radius)
    ++reached_;
  return reached_ == total();
}

Eigen::Vector2d WayPointDriver::command(const Eigen::Vector3d& T_world_robot, double dt) {
  const Eigen::Vector2d d = target() - T_world_robot.head<2>();
  const double error = wrap_angle(std::atan2(d.y(), d.x()) - T_world_robot.z());
  if (steers_) {
    const double most = to_radians(drive_.steering_rate_deg_s) * dt;
    const double limit = to_radians(drive_.steering_limit_deg);
    steering_ += std::clamp(wrap_angle(error - steering_), -most, most);
    steering_ = std::clamp(steering_, -limit, limit);
    return {drive_.speed, drive_.speed * std::tan(steering_) / wheelbase_};
  }
  const double limit = to_radians(drive_.turn_rate_limit_deg_s);
  return {drive_.speed * std::max(0.0, std::cos(error)),
          std::clamp(drive_.turn_gain * error, -limit, limit)};
}

double WayPointDriver::progress() const {
  return static_cast<double>(reached_) / static_cast<double>(total());
}

double WayPointDriver::length_from(const Eigen::Vector2d& start) const {
  double lap = (way_points_.front() - way_points_.back()).norm();
  for (std::size_t i = 1; i < way_points_.size(); ++i)
    lap += (way_points_[i] - way_points_[i - 1]).norm();
  return (way_points_.front() - start).norm() + lap * drive_.laps;
}

}  // namespace libslam
