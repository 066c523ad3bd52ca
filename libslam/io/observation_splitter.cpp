#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <libslam/io/arc_motion.hpp>
#include <libslam/io/observation_splitter.hpp>

namespace libslam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using mrpt::poses::CPose2D;

CPose2D to_pose(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

/// Counter difference that survives one overflow of the 32-bit counter.
std::int64_t counter_difference(std::int32_t now, std::int32_t before) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(now) -
                                   static_cast<std::uint32_t>(before));
}

}  // namespace

ObservationSplitter::ObservationSplitter(std::uint64_t max_pending_bytes)
    : max_pending_bytes_(max_pending_bytes), step_time_(-kInfinity) {}

double ObservationSplitter::last_reading_time() const {
  return end_ ? end_->time : begin_ ? begin_->time : -kInfinity;
}

void ObservationSplitter::add_observation(const mrpt::obs::CObservation::Ptr& observation,
                                          double time, std::uint64_t bytes) {
  const auto later = [](double t, const Waiting& w) { return t < w.time; };
  waiting_.insert(std::upper_bound(waiting_.begin(), waiting_.end(), time, later),
                  {time, observation, bytes});
  pending_bytes_ += bytes;
  if (pending_bytes_ > max_pending_bytes_) {
    if (end_) release_interval();
    release_without_motion(kInfinity);
  }
}

void ObservationSplitter::add_reading(const OdometryReading& reading) {
  if (end_) release_interval();
  if (begin_) {
    end_ = reading;
    return;
  }
  begin_ = reading;
  release_without_motion(std::nextafter(reading.time, -kInfinity));
}

void ObservationSplitter::finish() {
  if (end_) release_interval();
  release_without_motion(kInfinity);
}

void ObservationSplitter::release_interval() {
  Cut done;
  while (!waiting_.empty() && waiting_.front().time < end_->time) {
    const double time = waiting_.front().time;
    auto frame = take_frame();
    if (time <= begin_->time)
      emit(time, nullptr, 0.0, std::move(frame));
    else
      emit_part(time, std::move(frame), done);
  }
  const bool shared = !waiting_.empty() && waiting_.front().time <= end_->time;
  emit_part(end_->time, shared ? take_frame() : nullptr, done);
  begin_ = std::exchange(end_, std::nullopt);
}

void ObservationSplitter::release_without_motion(double up_to) {
  while (!waiting_.empty() && waiting_.front().time <= up_to) {
    const double time = waiting_.front().time;
    emit(time, nullptr, 0.0, take_frame());
  }
}

mrpt::obs::CSensoryFrame::Ptr ObservationSplitter::take_frame() {
  auto frame = mrpt::obs::CSensoryFrame::Create();
  const double time = waiting_.front().time;
  while (!waiting_.empty() && waiting_.front().time == time) {
    frame->insert(waiting_.front().observation);
    pending_bytes_ -= waiting_.front().bytes;
    waiting_.pop_front();
  }
  return frame;
}

void ObservationSplitter::emit_part(double time, mrpt::obs::CSensoryFrame::Ptr frame, Cut& done) {
  const double span = end_->time - begin_->time;
  const double fraction = span > 0.0 ? (time - begin_->time) / span : 1.0;
  if (begin_->twist) {
    emit(time, nullptr, (fraction - done.fraction) * span, std::move(frame));
    ready_.back().twist = HeldTwist{*begin_->twist, span};
    done.fraction = fraction;
    return;
  }
  const Eigen::Vector3d interval = [&] {
    const CPose2D difference = to_pose(end_->pose) - to_pose(begin_->pose);
    return Eigen::Vector3d(difference.x(), difference.y(), difference.phi());
  }();
  mrpt::obs::CActionRobotMovement2D motion;
  motion.timestamp = mrpt::Clock::fromDouble(time);
  motion.rawOdometryIncrementReading = to_pose(part_of_motion(interval, fraction - done.fraction));
  motion.poseChange = mrpt::poses::CPosePDFGaussian::Create(motion.rawOdometryIncrementReading,
                                                            mrpt::math::CMatrixDouble33());
  if (end_->velocity) {
    motion.hasVelocities = true;
    motion.velocityLocal = {end_->velocity->x(), end_->velocity->y(), end_->velocity->z()};
  }
  if (begin_->ticks && end_->ticks) {
    std::array<std::int64_t, 2> total{};
    for (std::size_t i = 0; i < 2; ++i)
      total[i] = std::llround(fraction * static_cast<double>(counter_difference(
                                             (*end_->ticks)[i], (*begin_->ticks)[i])));
    motion.hasEncodersInfo = true;
    motion.encoderLeftTicks = static_cast<std::int32_t>(total[0] - done.ticks[0]);
    motion.encoderRightTicks = static_cast<std::int32_t>(total[1] - done.ticks[1]);
    done.ticks = total;
  }
  const double dt = (fraction - done.fraction) * span;
  done.fraction = fraction;
  auto action = mrpt::obs::CActionCollection::Create();
  action->insert(motion);
  emit(time, std::move(action), dt, std::move(frame));
}

void ObservationSplitter::emit(double time, mrpt::obs::CActionCollection::Ptr action, double dt,
                               mrpt::obs::CSensoryFrame::Ptr frame) {
  step_time_ = std::max(step_time_, time);
  LogStep step;
  step.time = step_time_;
  step.dt = dt;
  step.action = std::move(action);
  step.frame = std::move(frame);
  ready_.push_back(std::move(step));
}

}  // namespace libslam
