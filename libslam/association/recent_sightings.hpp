#pragma once
// What was seen in the last frames, in today's robot frame: few landmarks at a time add up to a
// constellation. For a robot that does not know where it is but knows how it moves.

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/association/constellation.hpp>

namespace libslam {

/// An old and a new point within the chi-square probability .999 are one object and are fused, if
/// neither has another such partner; where two objects contest a sighting it is not used. Odometry
/// noise goes into each point by itself: that points
/// move together is not kept, so that the constellation counts as softer than it is.
class RecentSightings {
 public:
  /// A point or view older than `frames` calls of `add` is forgotten.
  explicit RecentSightings(std::size_t frames) : frames_(frames) {}

  /// The robot moves: its new frame in the old one, x [m], y [m], phi [rad], and its covariance.
  void move(const Eigen::Vector3d& T_old_new, const Eigen::Matrix3d& cov);
  /// One frame of points in the robot frame, from the sensor of `view`.
  void add(std::span<const PlanarPoint> seen, const SensorView& view);
  void clear();

  const std::vector<PlanarPoint>& points() const { return points_; }
  const std::vector<SensorView>& views() const { return views_; }

 private:
  void fuse(PlanarPoint& old, const PlanarPoint& again) const;

  std::size_t frames_, now_ = 0;
  std::vector<PlanarPoint> points_;
  std::vector<std::size_t> last_seen_;  // of points_
  std::vector<SensorView> views_;       // the oldest first
};

}  // namespace libslam
