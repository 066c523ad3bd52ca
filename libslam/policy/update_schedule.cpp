#include <stdexcept>
#include <string>

#include <libslam/policy/update_schedule.hpp>

namespace libslam {

namespace {
// Time stamps of rawlogs have a resolution of 100 ns; a frame that is early by rounding alone is
// due.
constexpr double kClockTolerance = 1e-4;
}  // namespace

UpdateSchedule::UpdateSchedule(double period, int every_n) : period_(period), every_n_(every_n) {
  if (!(period >= 0.0))
    throw std::invalid_argument("update period must be >= 0 s, got " + std::to_string(period));
  if (every_n < 1)
    throw std::invalid_argument("update_every_n must be >= 1, got " + std::to_string(every_n));
}

bool UpdateSchedule::due(double time) {
  if (frames_++ % every_n_ != 0) return false;
  if (started_ && time < next_ - kClockTolerance) return false;
  started_ = true;
  next_ = time + period_;
  return true;
}

}  // namespace libslam
