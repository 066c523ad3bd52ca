#pragma once
// What was seen recently, in the frame of the robot as it moves on: the constellation of a lost
// robot.

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/association/constellation.hpp>
#include <libslam/data/feature.hpp>

namespace libslam {

/// A feature as a point of the plane.
struct SightedPoint {
  std::int64_t id = kNoIdentity;
  PlanarPoint point;  ///< robot frame
};

/// The points of several observations, each object once. Sightings of one object are fused; the
/// noise of the odometry in between is taken as independent from point to point, which overstates
/// it.
class RecentSightings {
 public:
  /// A point is forgotten when it has not been seen in so many observations; throws
  /// std::invalid_argument unless >= 1.
  explicit RecentSightings(int memory);

  void clear();
  /// The robot has moved by `increment` in its frame before; covariance of (dx, dy, dphi).
  void move(const Eigen::Vector3d& increment, const Eigen::Matrix3d& cov);
  /// Adds an observation, seen from `view` as far as that is known.
  void add(std::span<const SightedPoint> observation, const SensorView& view);

  std::size_t size() const { return sightings_.size(); }
  std::vector<PlanarPoint> points() const;
  std::vector<SensorView> views() const;
  std::int64_t id(std::size_t point) const { return sightings_[point].seen.id; }
  /// For each point of the last observation its position among `points`.
  const std::vector<std::size_t>& latest() const { return latest_; }

 private:
  struct Sighting {
    SightedPoint seen;
    int age = 0;  // observations since
  };
  struct View {
    SensorView view;
    int age = 0;
  };
  /// The sighting of the same object, or that of none: size().
  std::size_t partner(const SightedPoint& point) const;
  bool is_latest(std::size_t sighting) const;

  int memory_;
  std::vector<Sighting> sightings_;
  std::vector<View> views_;
  std::vector<std::size_t> latest_;
};

}  // namespace libslam
