#pragma once
// Poses of the past that stay in the state, and the smoothed path that they carry.
//
// A clone of the pose is added to the state every so many metres or radians. It is correlated with
// everything and moves with each later correction, so that at the end of a log the clones are where
// all measurements put them, not only the earlier ones. Between two clones the path is what it was
// on line, relative to the first of them; the misclosure at the second is spread evenly over the
// steps in between. Source: Eustice, Singh & Leonard, "Exactly sparse delayed-state filters for
// view-based SLAM", IEEE Trans. Robotics 22(6), 2006 (the augmentation, in covariance form here).

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/trajectory.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

/// When the next pose is kept.
struct DelayedPoseSpacing {
  double distance = 0.0;  ///< from the last kept pose [m]
  double turn = 0.0;      ///< since the last kept pose [rad]
};

class DelayedPoses {
 public:
  /// Throws std::invalid_argument unless both are positive; infinity is allowed.
  explicit DelayedPoses(const DelayedPoseSpacing& spacing);

  /// Remembers how the planar `pose` of a step at `time` [s] stands to the last kept pose, and
  /// keeps it if it is far enough from there. Throws std::invalid_argument for a pose in space.
  void remember(GaussianState& state, BlockId pose, double time);
  /// The robot was put elsewhere: the next pose is kept, and nothing is spread over the jump.
  void restart() { restarted_ = true; }

  /// The pose that was kept last; nothing if the robot was put elsewhere since.
  std::optional<BlockId> latest() const {
    if (restarted_) return std::nullopt;
    return blocks_.back();
  }

  /// The remembered steps, given everything that the filter knows now.
  Trajectory path(const GaussianState& state) const;

 private:
  struct Step {
    double time;
    Eigen::Vector3d T_kept_robot;  ///< x [m], y [m], phi [rad]
  };
  /// The steps from one kept pose to the next; the last step is that of the next kept pose.
  struct Segment {
    std::size_t first_step = 0;
    bool joined = true;  ///< the next kept pose follows without a jump
  };

  void keep(GaussianState& state, BlockId pose);
  void append_segment(const GaussianState& state, std::size_t segment, Trajectory& path) const;

  DelayedPoseSpacing spacing_;
  std::vector<BlockId> blocks_;  // one per segment
  std::vector<Segment> segments_;
  std::vector<Step> steps_;
  bool restarted_ = true;
};

}  // namespace libslam
