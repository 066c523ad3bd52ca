#pragma once
// Poses of the past as blocks of the state: every later correction moves them, too, which makes the
// path behind the robot a smoothed one.

#include <vector>

#include <libslam/state/gaussian_state.hpp>

namespace libslam {

/// Clones the pose into the state after every `spacing` metres.
class DelayedPoses {
 public:
  /// Throws std::invalid_argument unless `spacing` is positive.
  explicit DelayedPoses(double spacing);

  /// The robot has moved by this [m].
  void moved(double distance) { travelled_ += distance; }
  /// To be called after a correction, where the pose is known best.
  void update(GaussianState& state, BlockId pose);

  /// The oldest first.
  const std::vector<BlockId>& poses() const { return poses_; }

 private:
  double spacing_, travelled_;
  std::vector<BlockId> poses_;
  Initialization clone_;
};

}  // namespace libslam
