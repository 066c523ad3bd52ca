#pragma once
// What a log holds, without running a filter on it.

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include <libslam/data/log_step.hpp>
#include <libslam/io/rawlog_guard.hpp>

namespace libslam {

/// One sensor: a label and the class of its observations.
struct SensorStatistics {
  std::int64_t count = 0;
  std::int64_t invalid_times = 0;            ///< no valid stamp
  std::int64_t backward_times = 0;           ///< stamp before that of the observation before
  double first_time = 0.0, last_time = 0.0;  ///< earliest and latest valid stamp [s]
  double longest_gap = 0.0;                  ///< [s]
  /// Mean rate [1/s]; 0 where it cannot be told.
  double rate() const;
};

struct OdometryStatistics {
  std::int64_t motions = 0;          ///< steps with a planar motion
  std::int64_t with_covariance = 0;  ///< of them with a covariance of their own
  std::int64_t with_velocities = 0;  ///< of them with velocities
  std::int64_t velocities_agree =
      0;  ///< velocity times dt is the increment within 10 % + 1 cm or 0.01 rad
  std::int64_t with_ticks = 0;  ///< of them with encoder ticks
  double path_length = 0.0;     ///< [m]
  double total_turn = 0.0;      ///< sum of |dphi| [rad]
  double max_speed = 0.0;       ///< [m/s], over steps with a known dt
  double max_turn_rate = 0.0;   ///< [rad/s]
};

struct LandmarkStatistics {
  std::int64_t sightings = 0;
  std::int64_t with_identity = 0;
  std::int64_t unusable = 0;                ///< range not positive, or something not finite
  std::set<std::int32_t> identities;        ///< no more than 100000 are kept
  double min_range = 0.0, max_range = 0.0;  ///< of usable sightings [m]
};

/// Collects the statistics of a log from its entries and its steps.
class LogInspection {
 public:
  void observe(const RawlogEntry& entry);
  void observe(const LogStep& step);

  const std::map<std::string, std::int64_t>& classes() const { return classes_; }
  /// By "label (class)".
  const std::map<std::string, SensorStatistics>& sensors() const { return sensors_; }
  const OdometryStatistics& odometry() const { return odometry_; }
  const LandmarkStatistics& landmarks() const { return landmarks_; }
  std::int64_t steps() const { return steps_; }
  double first_time() const { return first_time_; }
  double last_time() const { return last_time_; }

 private:
  void observe(const mrpt::obs::CObservation& observation);

  std::map<std::string, std::int64_t> classes_;
  std::map<std::string, SensorStatistics> sensors_;
  OdometryStatistics odometry_;
  LandmarkStatistics landmarks_;
  std::int64_t steps_ = 0;
  double first_time_ = 0.0, last_time_ = 0.0;
};

}  // namespace libslam
