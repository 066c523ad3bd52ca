#pragma once
// When a frame may update the filter. Between updates odometry goes on.

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include <libslam/config/parameters/policies.hpp>

namespace libslam {

/// Sensor errors of real logs are correlated in time; a filter that takes every frame as fresh
/// information becomes overconfident. And the features that are in view bound the error, so that
/// the more there are, the later the next update may come (Lou et al., China Mech. Eng. 22(24),
/// 2011, eq. 16; S2.16): after an update with s features
///
///   T = T_s (1 + mu s)   relative, mu = per_feature [1], or
///   T = T_s + mu s       absolute, mu = per_feature [s]
///
/// pass, T_s = update_period_s. Frames come at the period of the sensor, to which T is thereby
/// rounded up. All conditions must hold: every n-th frame with features, the time T, and the way or
/// the turn since the last update (either of the two, where both are given).
class UpdateSchedule {
 public:
  /// Throws std::invalid_argument if a period, a factor, a way or a turn is negative or
  /// update_every_n < 1.
  explicit UpdateSchedule(const PolicyParameters& policies);

  /// True if no frame at `time` [s] can be due, whatever is in it: it need not be looked at, and is
  /// taken for one with features. False while frames are counted.
  bool skip(double time, const Eigen::Vector3d& pose);
  /// True if a frame with `features` > 0 features at `time` [s] is due; counts the frame. `pose`:
  /// where the filter is, x [m], y [m], phi [rad].
  bool due(double time, const Eigen::Vector3d& pose, int features);

  /// What the features saved: updates made, and those that T_s alone would have made.
  struct Savings {
    std::int64_t updates = 0, without_stretch = 0;
  };
  /// Nothing where per_feature is 0.
  std::optional<Savings> savings() const;

 private:
  bool waits(double next, double time) const;
  bool has_moved(const Eigen::Vector3d& pose) const;
  double stretched(int features) const;
  /// The update that T_s alone would have made now.
  void count_without_stretch(double time);

  double period_, per_feature_, distance_, turn_;
  bool relative_;
  int every_n_;
  double next_ = 0.0, next_without_stretch_ = 0.0;
  bool started_ = false;
  std::int64_t frames_ = 0;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();  // pose of the last update
  Savings savings_;
};

}  // namespace libslam
