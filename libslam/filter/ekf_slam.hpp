#pragma once
// The five-line step: EKF-SLAM as a composition of motion, measurement, association and error
// frame.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <libslam/association/associator.hpp>
#include <libslam/association/landmark_registry.hpp>
#include <libslam/data/motion_action.hpp>
#include <libslam/data/phase_times.hpp>
#include <libslam/data/step_record.hpp>
#include <libslam/filter/building_prior.hpp>
#include <libslam/filter/calibration_states.hpp>
#include <libslam/filter/delayed_poses.hpp>
#include <libslam/filter/displacement_update.hpp>
#include <libslam/filter/disturbance_response.hpp>
#include <libslam/filter/ekf.hpp>
#include <libslam/filter/iterated_update.hpp>
#include <libslam/filter/landmark_merging.hpp>
#include <libslam/filter/linearizer.hpp>
#include <libslam/filter/loop_closure.hpp>
#include <libslam/filter/map_start.hpp>
#include <libslam/filter/selected_pairs.hpp>
#include <libslam/measurement/measurement_model.hpp>
#include <libslam/motion/motion_model.hpp>
#include <libslam/policy/implied_input.hpp>
#include <libslam/policy/noise_policy.hpp>
#include <libslam/policy/process_scale.hpp>

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
  std::unique_ptr<NoisePolicy> noise;              ///< null: R as the features bring it
  std::unique_ptr<ProcessScale> process;           ///< null: Q as the motion model says
  std::optional<IteratedUpdate> iteration;         ///< absent: one linearization per correction
  std::optional<DisturbanceResponse> disturbance;  ///< absent: every observation is believed
  std::optional<ImpliedInput> implied_input;       ///< absent: any motion is possible
  double extent_gap = 0.0;              ///< farthest that two parts of one line lie apart [m]
  std::optional<DelayedPoses> delayed;  ///< absent: the past is forgotten
  LandmarkRegistry registry{1, 0};
  std::optional<LandmarkMerging> merging;       ///< absent: landmarks stay apart
  std::optional<LoopClosure> loop_closure;      ///< absent: association alone closes loops
  std::optional<BuildingPrior> building_prior;  ///< absent: walls may run in any direction
  std::optional<MapStart> map;  ///< to start in; needs no point of linearization but the estimate
  BlockVector start;  ///< start pose, storage of the motion model's pose; empty: the origin
  BlockMatrix cov_start = BlockMatrix::Zero(3, 3);        ///< of its error, tangent coordinates
  BlockMatrix cov_no_odometry = BlockMatrix::Zero(3, 3);  ///< added by a step without odometry
};

/// What one observation did to the filter.
struct UpdateOutcome {
  double nis = 0.0;
  int nis_dof = 0;
  int accepted = 0, gated = 0, ambiguous = 0, new_landmarks = 0;
  std::vector<Verdict> verdicts;  ///< one per feature
  /// What a run should tell: "disturbance", "lost", "relocalized", "impossible_motion", joined as
  /// data/step_events.hpp says.
  std::string event;

  UpdateOutcome& operator+=(const UpdateOutcome& other);
};

class EkfSlam {
 public:
  /// Throws std::invalid_argument if a part is missing, the error frame does not support a block,
  /// or the map to start in does not fit.
  explicit EkfSlam(EkfSlamParts parts);

  /// Moves the robot; null: a step without odometry.
  void propagate(const MotionAction* action);
  /// Associates the features of one observation, corrects, and adds the new landmarks; or measures
  /// the displacement since the reading before, gates and corrects.
  UpdateOutcome update(std::span<const Feature> features);

  /// The end of a step at `time` [s]: its pose becomes part of the smoothed path. Nothing where the
  /// past is forgotten.
  void remember_pose(double time);
  /// What a scanner sees from the present pose, `points` [m] in the frame of the robot, after the
  /// pose was remembered. True: a loop was closed. Nothing without loop closure.
  bool look_for_loops(std::span<const Eigen::Vector2d> points);
  const LoopClosure* loop_closure() const {
    return parts_.loop_closure ? &*parts_.loop_closure : nullptr;
  }
  /// The path of all steps remembered, given everything known now; nothing where the past is
  /// forgotten.
  std::optional<Trajectory> smoothed_path() const;

  /// Nothing is known of the pose: it is searched in the map. Throws std::invalid_argument if the
  /// filter does not respond to disturbances.
  void lose_pose();
  /// Localization from now on: the landmarks keep their estimates and covariances, which count in
  /// every innovation, and none is added (MapStart::landmarks_given); or SLAM again.
  void give_landmarks(bool given);

  /// What is estimated, and shadows of it (filter/hindsight.hpp).
  const GaussianState& state() const { return state_; }
  /// Of all that is estimated, in state order: full symmetric, without the shadows.
  Eigen::MatrixXd covariance() const;
  BlockId pose() const { return pose_; }
  const LandmarkRegistry& registry() const { return parts_.registry; }
  const PhaseTimes& times() const { return times_; }
  PhaseTimes& times() { return times_; }

  std::vector<CalibrationValue> calibration() const { return calibration_.values(state_); }
  /// What the policies believe of the noise; empty without one.
  std::vector<AdaptedNoise> noise() const;
  /// Landmarks by identity; provisional ones only on demand.
  std::vector<LandmarkEstimate> landmarks(bool with_provisional = false) const;
  /// The map with everything a filter needs to go on from here. Throws std::invalid_argument if it
  /// measures displacements and has no map.
  SavedMap saved_map() const;
  /// False once an estimate or a variance is not finite or a variance is negative.
  bool healthy() const;

 private:
  bool disturbed() const { return parts_.disturbance && parts_.disturbance->disturbed(); }
  std::span<const LinearizedMeasurement> accepted() const {
    return std::span(measured_).first(used_.size());
  }
  const DisplacementModel* displacement_model() const;
  void start_in_map();
  void scale_process_noise();
  void learn_process_noise();
  UpdateOutcome measure_displacement(const Feature& reading);
  /// Blocks that count with their uncertainty in a correction and do not learn.
  std::span<const BlockId> considered();
  // The steps of an update, each leaving behind what the next one needs.
  AssociatedObservation associate(std::span<const Feature> features);
  void linearize_pairs(std::span<const Feature> features);
  void respond(std::span<const Feature> features, UpdateOutcome& outcome);
  void start_again_at(const FoundPose& found, std::span<const Feature> features);
  void reconsider(UpdateOutcome& outcome);
  /// Gives up an observation that implies an impossible motion; the landmarks start anew, unless
  /// they are given.
  void reject_impossible(std::span<const Feature> features, UpdateOutcome& outcome);
  std::optional<Extent> sighted_part(BlockId landmark, const Feature& feature) const;
  void keep_up();
  /// How the accepted pairs fit; the noise policy learns from them. False: they cannot be used.
  bool weigh();
  Correction correct_with_pairs(std::span<const Feature> features);
  void correct(std::span<const Feature> features, UpdateOutcome& outcome);
  void add_landmarks(std::span<const Feature> features, UpdateOutcome& outcome);

  EkfSlamParts parts_;
  Ekf ekf_;
  Linearizer linearizer_;
  GaussianState state_;
  BlockId pose_;
  CalibrationStates calibration_;
  std::vector<BlockId> considered_;  // the given landmarks, then calibration
  std::size_t given_ = 0;            // how many of them are landmarks
  bool landmarks_given_ = false;     // localization: no new landmarks
  MotionStep step_;
  std::vector<Feature> adapted_;  // the features with the noise of the policy
  std::vector<Verdict> verdicts_;
  SelectedPairs selected_pairs_;
  std::vector<LinearizedMeasurement> measured_;  // accepted ones, then rejected ones
  std::vector<std::size_t> used_;                // the features behind the accepted ones
  std::vector<Postfit> postfits_;
  JointInnovation joint_;
  Initialization initialization_;
  PhaseTimes times_;
};

}  // namespace libslam
