#pragma once
// What a filter does while something moves the robot that its odometry does not know of.
//
//   quiet      -> every update is tested; where most of what is seen is new, the map is searched
//                 for it now and then: perhaps the robot has been carried off unseen
//   disturbed  -> before each correction the pose gets the covariance that explains the
//                 observation, which is then associated anew; new landmarks wait
//   lost       -> nothing explained several updates in a row: the whole map is searched for what
//                 was seen since the disturbance began, and nothing else is believed

#include <functional>
#include <optional>
#include <span>

#include <libslam/association/associator.hpp>
#include <libslam/association/landmark_registry.hpp>
#include <libslam/data/joint_innovation.hpp>
#include <libslam/filter/ekf.hpp>
#include <libslam/filter/hindsight.hpp>
#include <libslam/filter/relocalizer.hpp>
#include <libslam/measurement/measurement_model.hpp>
#include <libslam/policy/disturbance.hpp>
#include <libslam/state/gaussian_state.hpp>

namespace libslam {

/// One observation between association and correction.
struct AssociatedObservation {
  std::span<const Feature> features;
  std::span<const Verdict> verdicts;                  ///< one per feature
  std::span<const LinearizedMeasurement> paired;      ///< of the verdicts kPaired
  std::span<const LinearizedMeasurement> identified;  ///< paired, then kGated: with a partner
};

/// What the filter lends; all of it outlives the call.
struct RespondingFilter {
  GaussianState& state;
  BlockId pose;
  Ekf& ekf;
  const MeasurementModel& measurement;
  const LandmarkRegistry& registry;
  /// Associates the same features anew.
  std::function<AssociatedObservation()> associate;
};

enum class Doubt {
  kNone,         ///< use the observation as it is associated
  kDisturbed,    ///< likewise, but it adds no landmark
  kUnexplained,  ///< do not use it
};

struct ResponseOptions {
  double near_landmark = 10.0;  ///< a feature this near to a landmark should fit one [m]
  int lost_after = 3;           ///< updates in a row that nothing explains
  bool relocalize = true;       ///< planar poses and points alone
  double slip_probability = 0;  ///< of a slip that only hindsight shows; 0: not looked for
};

class DisturbanceResponse {
 public:
  /// Throws std::invalid_argument unless `near_landmark` >= 0, `lost_after` >= 1 and
  /// `slip_probability` is in [0, 1).
  DisturbanceResponse(Disturbance policy, const ResponseOptions& options);

  /// The robot has moved: where the pose block was before, and the covariance of the step.
  void moved(const Eigen::VectorXd& before, const Eigen::VectorXd& after, const BlockMatrix& cov);
  /// To be called before the correction; may inflate the covariance and associate anew.
  Doubt answer(const RespondingFilter& filter, const AssociatedObservation& observation);
  /// After an `answer`: the pose of a lost robot, if the map shows it.
  std::optional<FoundPose> search_map(const RespondingFilter& filter,
                                      std::span<const Feature> features);

  /// After an `answer` without doubt: a pose elsewhere in the map that explains what was seen
  /// recently, where most of it has just been taken for new. Its landmarks younger than `kYoung`
  /// updates are then second copies.
  std::optional<FoundPose> recognize(const RespondingFilter& filter,
                                     const AssociatedObservation& observation);
  static constexpr int kYoung = 100;
  /// Right before a correction.
  void open(GaussianState& state, BlockId pose);
  /// After it; true if hindsight shows a slip, for which state and policy then have been corrected.
  /// The blocks in `given` do not change.
  bool reconsider(GaussianState& state, BlockId pose, Ekf& ekf, std::span<const BlockId> given);
  /// The pose has been set anew.
  void pose_found();

  bool relocalizes() const { return options_.relocalize; }
  /// Blocks of the state that serve hindsight alone.
  std::span<const BlockId> shadows() const;

  /// Nothing is known of the pose: the map will be searched for it.
  void lose();
  bool disturbed() const { return policy_.lasts() || lost(); }
  bool lost() const { return unexplained_ >= options_.lost_after; }
  /// The last `answer` began a disturbance.
  bool began() const { return policy_.began(); }
  /// The last `answer` lost the pose.
  bool became_lost() const { return unexplained_ == options_.lost_after; }

 private:
  /// Judges what no identity says where it belongs.
  bool estranged(const RespondingFilter& filter, const AssociatedObservation& observation,
                 bool pairs_fit);
  /// Innovations that count: those the gate rejected only where they are many.
  std::span<const LinearizedMeasurement> evidence(const AssociatedObservation& observation) const;
  Doubt inflate(const RespondingFilter& filter);
  Doubt search(const RespondingFilter& filter);
  Doubt stay_lost(const RespondingFilter& filter, const AssociatedObservation& observation);
  bool plausible(const RespondingFilter& filter, const AssociatedObservation& observation,
                 std::size_t enough_pairs);
  Doubt settle_on(bool explained);
  void settle();

  Disturbance policy_;
  ResponseOptions options_;
  Relocalizer relocalizer_;
  std::optional<Hindsight> hindsight_;
  int unexplained_ = 0;         // updates in a row
  int unpaired_ = 0;            // updates in a row of which half or more fits nothing
  std::size_t last_pairs_ = 0;  // of the update before
  int searched_ = 0;            // updates since the map was last searched without a doubt
  bool vanished_ = false;       // all landmarks in view were gone at once, and others there
  JointInnovation joint_;
};

}  // namespace libslam
