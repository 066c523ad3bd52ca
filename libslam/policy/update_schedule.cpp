#include <cmath>
#include <stdexcept>
#include <string>

#include <libslam/policy/update_schedule.hpp>

namespace libslam {

namespace {
constexpr double kPi = 3.141592653589793;
// Time stamps of rawlogs have a resolution of 100 ns; a frame that is early by rounding alone is
// due.
constexpr double kClockTolerance = 1e-4;

double not_negative(const std::string& name, double value) {
  if (!(value >= 0.0))
    throw std::invalid_argument(name + " must be >= 0, got " + std::to_string(value));
  return value;
}
}  // namespace

UpdateSchedule::UpdateSchedule(const PolicyParameters& policies)
    : period_(not_negative("update_period_s", policies.update_period_s)),
      per_feature_(
          not_negative("update_schedule.per_feature", policies.update_schedule.per_feature)),
      distance_(not_negative("update_schedule.distance", policies.update_schedule.distance)),
      turn_(not_negative("update_schedule.turn_deg", policies.update_schedule.turn_deg) * kPi /
            180.0),
      relative_(policies.update_schedule.form == "relative"),
      every_n_(policies.update_every_n) {
  if (every_n_ < 1)
    throw std::invalid_argument("update_every_n must be >= 1, got " + std::to_string(every_n_));
}

bool UpdateSchedule::waits(double next, double time) const {
  return started_ && time < next - kClockTolerance;
}

bool UpdateSchedule::has_moved(const Eigen::Vector3d& pose) const {
  if (!started_ || (distance_ == 0.0 && turn_ == 0.0)) return true;
  const Eigen::Vector3d moved = pose - last_;
  return (distance_ > 0.0 && moved.head<2>().norm() >= distance_) ||
         (turn_ > 0.0 && std::abs(std::remainder(moved.z(), 2.0 * kPi)) >= turn_);
}

double UpdateSchedule::stretched(int features) const {
  const double stretch = per_feature_ * features;
  return relative_ ? period_ * (1.0 + stretch) : period_ + stretch;
}

void UpdateSchedule::count_without_stretch(double time) {
  if (waits(next_without_stretch_, time)) return;
  ++savings_.without_stretch;
  next_without_stretch_ = time + period_;
}

bool UpdateSchedule::skip(double time, const Eigen::Vector3d& pose) {
  if (every_n_ > 1) return false;
  if (!has_moved(pose)) return true;
  if (!waits(next_, time)) return false;
  count_without_stretch(time);
  return true;
}

bool UpdateSchedule::due(double time, const Eigen::Vector3d& pose, int features) {
  if (frames_++ % every_n_ != 0) return false;
  if (!has_moved(pose)) return false;
  count_without_stretch(time);
  if (waits(next_, time)) return false;
  started_ = true;
  next_ = time + stretched(features);
  last_ = pose;
  ++savings_.updates;
  return true;
}

std::optional<UpdateSchedule::Savings> UpdateSchedule::savings() const {
  if (per_feature_ == 0.0) return std::nullopt;
  return savings_;
}

}  // namespace libslam
