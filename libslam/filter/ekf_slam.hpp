#pragma once
// The five-line step: EKF-SLAM as a composition of motion, measurement, association and error
// frame.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/association/associator.hpp>
#include <libslam/association/landmark_registry.hpp>
#include <libslam/data/motion_action.hpp>
#include <libslam/data/phase_times.hpp>
#include <libslam/data/step_record.hpp>
#include <libslam/filter/displacement_update.hpp>
#include <libslam/filter/ekf.hpp>
#include <libslam/filter/linearizer.hpp>
#include <libslam/measurement/measurement_model.hpp>
#include <libslam/motion/motion_model.hpp>
#include <libslam/policy/excitation.hpp>

namespace libslam {

/// The interchangeable parts of a filter; pointers are required where nothing else is said.
struct EkfSlamParts {
  std::unique_ptr<MotionModel> motion;
  std::unique_ptr<MeasurementModel> measurement;
  std::unique_ptr<Associator> associator;
  std::unique_ptr<ErrorFrame> frame;
  std::unique_ptr<LinearizationPoint> linearization;  ///< null: at the estimate
  /// Present: features are readings of a sensor's own path, and there is no map; `measurement` and
  /// `associator` may then be null.
  std::optional<DisplacementUpdate> displacement;
  LandmarkRegistry registry{1, 0};
  Eigen::Matrix3d cov_start = Eigen::Matrix3d::Zero();  ///< covariance of the start pose (0, 0, 0)
  Eigen::Matrix3d cov_no_odometry = Eigen::Matrix3d::Zero();  ///< added by a step without odometry
};

/// What one observation did to the filter.
struct UpdateOutcome {
  double nis = 0.0;
  int nis_dof = 0;
  int accepted = 0, gated = 0, ambiguous = 0, new_landmarks = 0;
  std::vector<Verdict> verdicts;  ///< one per feature

  UpdateOutcome& operator+=(const UpdateOutcome& other);
};

class EkfSlam {
 public:
  /// Throws std::invalid_argument if a part is missing or the error frame does not support a block.
  explicit EkfSlam(EkfSlamParts parts);

  /// Moves the robot; null: a step without odometry.
  void propagate(const MotionAction* action);
  /// Associates the features of one observation, corrects, and adds the new landmarks; or measures
  /// the displacement since the reading before, gates and corrects.
  UpdateOutcome update(std::span<const Feature> features);

  const GaussianState& state() const { return state_; }
  BlockId pose() const { return pose_; }
  const LandmarkRegistry& registry() const { return parts_.registry; }
  const PhaseTimes& times() const { return times_; }
  PhaseTimes& times() { return times_; }

  std::vector<CalibrationValue> calibration() const;
  /// Landmarks by identity; provisional ones only on demand.
  std::vector<LandmarkEstimate> landmarks(bool with_provisional = false) const;
  /// False once an estimate or a variance is not finite or a variance is negative.
  bool healthy() const;

 private:
  class PairTest;
  void add_calibration();
  CalibrationBlocks add_blocks(const std::vector<CalibrationSpec>& parameters);
  UpdateOutcome measure_displacement(const Feature& reading);
  void observe_excitation(double dt);
  void add_landmarks(std::span<const Feature> features, UpdateOutcome& outcome);

  EkfSlamParts parts_;
  Ekf ekf_;
  Linearizer linearizer_;
  GaussianState state_;
  BlockId pose_;
  std::vector<CalibrationSpec> parameters_;  // of the motion, then of the sensor
  CalibrationBlocks motion_calibration_, sensor_calibration_;
  CalibrationBlocks calibration_;  // both, as `parameters_`
  Excitation excitation_;
  MotionStep step_;
  Eigen::Matrix3Xd calibration_jacobian_;
  std::vector<BlockId> considered_;  // calibration that is not excited now
  std::vector<LinearizedMeasurement> accepted_;
  std::vector<Verdict> verdicts_;
  Initialization initialization_;
  PhaseTimes times_;
};

}  // namespace libslam
