#pragma once
// Contract of models of a sensor that measures how far it moved.
//
// Given   a state with the pose now, a clone of the pose at an earlier reading (a delayed pose
//         block) and the calibration blocks the model asked for, and the two readings,
// Then    `linearize` returns innovation (angles wrapped), derivatives and noise in the additive
//         chart; the state is not touched.

#include <vector>

#include <Eigen/Core>

#include <libslam/data/feature.hpp>
#include <libslam/state/calibration_spec.hpp>
#include <libslam/state/gaussian_state.hpp>
#include <libslam/state/linearization.hpp>

namespace libslam {

/// Where the robot was at two readings of the sensor: SE2 blocks of the state.
struct PosePair {
  BlockId before, now;
};

class DisplacementModel {
 public:
  virtual ~DisplacementModel() = default;

  /// The parameters that are switched on, in the order the model expects their blocks.
  virtual const std::vector<CalibrationSpec>& calibration() const = 0;

  /// `blocks`: as `calibration()`. `before`, `now`: readings at the two poses. Fills `out`
  /// completely. Throws std::invalid_argument on another number of blocks.
  virtual void linearize(const GaussianState& state, const PosePair& poses,
                         const CalibrationBlocks& blocks, const Feature& before, const Feature& now,
                         LinearizedMeasurement& out) const = 0;

  /// Which part of a robot movement (dx, dy, dphi; robot frame) makes each parameter visible:
  /// column i is zero where the movement says nothing about parameter i (policy/excitation.hpp).
  virtual Eigen::Matrix3Xd excitation(const Eigen::Vector3d& movement) const = 0;
};

}  // namespace libslam
