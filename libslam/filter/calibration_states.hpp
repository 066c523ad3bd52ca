#pragma once
// The calibration parameters of a filter: their blocks, and which of them the motion shows now.

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/step_record.hpp>
#include <libslam/filter/linearizer.hpp>
#include <libslam/measurement/displacement_model.hpp>
#include <libslam/motion/motion_model.hpp>
#include <libslam/policy/excitation.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

class CalibrationStates {
 public:
  /// `sensor` may be null. No block exists until `add_to`.
  CalibrationStates(const MotionModel& motion, const DisplacementModel* sensor);

  /// Adds a block per parameter, those of the motion first.
  void add_to(GaussianState& state, Linearizer& linearizer);

  bool empty() const { return blocks_.empty(); }
  /// All, those of the motion first.
  const CalibrationBlocks& blocks() const { return blocks_; }
  const CalibrationBlocks& of_motion() const { return motion_; }
  const CalibrationBlocks& of_sensor() const { return sensor_; }

  /// Watches one motion step: `step` linearized at the pose that `state` still has.
  void observe(const GaussianState& state, BlockId pose, const MotionStep& step, double dt,
               const DisplacementModel* sensor);
  /// Random walks over `dt` [s].
  void diffuse(GaussianState& state, double dt) const;
  /// Every parameter.
  std::span<const BlockId> all() const { return blocks_; }
  /// Parameters that are not excited now: they count with their uncertainty, but do not learn.
  std::span<const BlockId> considered() const { return considered_; }

  /// What the monitor of the excitation remembers (policy/excitation.hpp); empty where it has seen
  /// nothing.
  std::vector<double> memory() const;
  /// Goes on from `memory` of the same parameters. Throws std::invalid_argument like Excitation.
  void remember(std::span<const double> memory);

  std::vector<CalibrationValue> values(const GaussianState& state) const;
  /// Every estimate is finite and every variance finite and not negative.
  bool healthy(const GaussianState& state) const;

 private:
  void consider();

  std::vector<CalibrationSpec> parameters_;  // of the motion, then of the sensor
  std::size_t motion_count_;
  CalibrationBlocks blocks_, motion_, sensor_;
  Excitation excitation_;
  bool watched_ = false;
  Eigen::Matrix3Xd jacobian_;
  std::vector<BlockId> considered_;
};

}  // namespace libslam
