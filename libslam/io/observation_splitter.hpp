#pragma once
// Observation-only logs: absolute odometry and time stamps become motions and frames in turn.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <mrpt/obs/CObservation.h>

#include <libslam/data/log_step.hpp>

namespace libslam {

/// One odometry reading: a pose in the odometry frame, absolute, or a velocity in space.
struct OdometryReading {
  double time = 0.0;                               ///< [s]
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< x [m], y [m], phi [rad]
  std::optional<Eigen::Vector3d> velocity;         ///< vx, vy [m/s], omega [rad/s]: mean since the
                                                   ///< previous reading
  std::optional<std::array<std::int32_t, 2>> ticks;  ///< absolute counters left, right; may wrap
  /// Velocity of the robot that holds until the next reading (HeldTwist); instead of a pose.
  std::optional<Eigen::Matrix<double, 6, 1>> twist;
};

/// Places every observation at its time stamp inside the odometry.
///
/// The interval between two readings is cut at the observations within it, in proportion to time
/// (constant velocity), so that the increments of its parts compose to the difference of the
/// absolute poses. All parts carry the mean velocity that the log gave for the interval. Ticks are
/// cut by rounding the running total: their sum is exact and no cut is off by more than half a
/// tick. Of velocities in space every part carries the reading that began the interval.
/// Observations of equal time become one frame; an observation at the time of a reading shares its
/// step.
///
/// An interval is released when the reading after it arrives: an observation may stand in the file
/// up to one reading late. Observations after the last reading get no motion, and so do those
/// before the first. Memory: one interval, and no more than `max_pending_bytes` of waiting
/// observations; beyond that (odometry that stopped) they are released without motion, which is
/// then applied later.
class ObservationSplitter {
 public:
  static constexpr std::uint64_t kMaxPendingBytes = 256ULL << 20;

  explicit ObservationSplitter(std::uint64_t max_pending_bytes = kMaxPendingBytes);

  /// `time` >= `open_time()`; `bytes` counts towards the limit of waiting observations.
  void add_observation(const mrpt::obs::CObservation::Ptr& observation, double time,
                       std::uint64_t bytes);
  /// `reading.time` >= time of the reading before.
  void add_reading(const OdometryReading& reading);
  /// Releases what waits.
  void finish();

  /// Steps that are complete; `index` is not set.
  std::deque<LogStep>& ready() { return ready_; }
  /// Observations before this time come too late to be placed; -infinity at the start.
  double open_time() const { return step_time_; }
  /// Time of the last reading; -infinity at the start.
  double last_reading_time() const;

 private:
  struct Waiting {
    double time;
    mrpt::obs::CObservation::Ptr observation;
    std::uint64_t bytes;
  };
  struct Cut {
    double fraction = 0.0;
    std::array<std::int64_t, 2> ticks{};
  };

  void release_interval();
  void release_without_motion(double up_to);
  mrpt::obs::CSensoryFrame::Ptr take_frame();
  void emit(double time, mrpt::obs::CActionCollection::Ptr action, double dt,
            mrpt::obs::CSensoryFrame::Ptr frame);
  void emit_part(double time, mrpt::obs::CSensoryFrame::Ptr frame, Cut& done);

  std::uint64_t max_pending_bytes_;
  std::uint64_t pending_bytes_ = 0;
  std::deque<Waiting> waiting_;                 ///< by time; equal times in order of arrival
  std::optional<OdometryReading> begin_, end_;  ///< the interval that is open
  double step_time_;
  std::deque<LogStep> ready_;
};

}  // namespace libslam
