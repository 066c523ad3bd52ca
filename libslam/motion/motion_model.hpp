#pragma once
// Contract of motion models.
//
// Given   a state that holds the blocks the model asked for, and one odometry step,
// Then    `linearize` returns the new pose, its derivatives with respect to the pose and to every
//         calibration block, and the process noise, all in the additive (standard) chart of the
//         blocks; the state is not touched;
// and     `sample` draws a new pose from the same distribution.

#include <random>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/motion_action.hpp>
#include <libslam/state/calibration_spec.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

class MotionModel {
 public:
  virtual ~MotionModel() = default;

  /// The pose block that the model moves: SE2 or SE3.
  virtual BlockSpec pose_spec() const { return {"pose", Chart::kSE2, 3, WorldRole::kPose}; }

  /// The parameters that are switched on, in the order the model expects their blocks.
  virtual const std::vector<CalibrationSpec>& calibration() const = 0;

  /// `pose`: block as `pose_spec`; `blocks`: as `calibration()`. Fills `step` completely.
  /// Throws std::invalid_argument if the action lacks the input that the model is configured for.
  virtual void linearize(const GaussianState& state, BlockId pose, const CalibrationBlocks& blocks,
                         const MotionAction& action, MotionStep& step) const = 0;

  /// Draws the pose after `action` from `pose` (storage of `pose_spec`) with the calibration values
  /// given.
  virtual BlockVector sample(const BlockVector& pose, const Eigen::VectorXd& calibration,
                             const MotionAction& action, std::mt19937_64& random) const = 0;
};

}  // namespace libslam
