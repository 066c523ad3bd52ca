#pragma once
// What a scanner saw along the path, tied to the delayed poses of the state.

#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/filter/surface_grid.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

/// One scan and the delayed pose that it moves with.
struct SeenPlace {
  BlockId kept;
  Eigen::Vector3d T_kept_place;         ///< x [m], y [m], phi [rad]
  double way = 0.0;                     ///< travelled so far [m]
  std::vector<Eigen::Vector2d> points;  ///< in the frame of the place [m]

  Eigen::Vector3d T_world_place(const GaussianState& state) const;
};

/// Places [first, last) of a stretch of the path, seen together.
struct PathStretch {
  std::size_t first = 0, last = 0;
  std::size_t middle() const { return first + (last - first) / 2; }
};

class PathMemory {
 public:
  /// Remembers what is seen from `pose` if that is far enough from the last place; true: it is.
  /// `kept`: a delayed pose not far behind.
  bool remember(const GaussianState& state, BlockId pose, BlockId kept,
                std::span<const Eigen::Vector2d> points);

  /// The robot was put elsewhere: no stretch and no view holds places from before and after.
  void restart() { open_ = first_ = places_.size(); }

  std::span<const SeenPlace> places() const { return places_; }
  /// Complete stretches, each half overlapping the next.
  std::span<const PathStretch> stretches() const { return stretches_; }
  /// The last places within `length` [m] of way; never empty once there is a place.
  PathStretch recent(double length) const;
  /// Scans in the frame of the place `frame`.
  std::vector<SurfaceScan> scans(const GaussianState& state, const PathStretch& stretch,
                                 std::size_t frame) const;

 private:
  std::vector<SeenPlace> places_;
  std::vector<PathStretch> stretches_;
  std::size_t first_ = 0;  // since the last restart
  std::size_t open_ = 0;   // where the next stretch begins
};

/// One point per square of width `spacing` [m].
std::vector<Eigen::Vector2d> thinned_points(std::span<const SurfaceScan> scans, double spacing);

}  // namespace libslam
