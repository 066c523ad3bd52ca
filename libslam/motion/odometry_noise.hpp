#pragma once
// How far odometry can be trusted: variances that grow with time, distance and turning.
//
//   var = (s_time)^2 dt + (s_distance)^2 |ds| + (s_turn)^2 |dphi|
//
// Every part is linear in its amount, so that an interval split in two carries the same total
// variance as the whole: the result does not depend on the rate of the log.

#include <Eigen/Core>

#include <libslam/config/parameters.hpp>

namespace libslam {

/// The independent noise inputs of a planar motion, in the order of every noise vector here:
/// along [m], across [m] (left positive), turn [rad], steering [rad].
enum NoiseInput : Eigen::Index { kAlong, kAcross, kTurn, kSteering, kNoiseInputs };

using NoiseVector = Eigen::Matrix<double, kNoiseInputs, 1>;

class OdometryNoise {
 public:
  explicit OdometryNoise(const OdometryNoiseParameters& parameters) : parameters_(parameters) {}

  /// True where the covariance of a log, if there is one, takes the place of `variance`.
  bool prefers_log() const { return parameters_.from_log; }

  /// Variances of the noise inputs over `dt` [s], `distance` [m] and `turn` [rad]; signs do not
  /// matter. Steering is noise of a reading that was held during dt: its variance is density^2 /
  /// dt. With dt = 0 (unknown) the parts that need the time, steering among them, are 0.
  NoiseVector variance(double dt, double distance, double turn) const;

 private:
  OdometryNoiseParameters parameters_;
};

}  // namespace libslam
