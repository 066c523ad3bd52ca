#pragma once
// What a filter does while something moves the robot that its odometry does not know of.
//
//   quiet      -> every update is tested, nothing else
//   disturbed  -> before each correction the pose gets the covariance that explains the
//                 observation, which is then associated anew; new landmarks wait
//   lost       -> nothing explained several updates in a row; the caller may search the whole map

#include <functional>
#include <span>

#include <libslam/association/associator.hpp>
#include <libslam/association/landmark_registry.hpp>
#include <libslam/data/joint_innovation.hpp>
#include <libslam/filter/ekf.hpp>
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
  kNone,        ///< use the observation as it is associated
  kDisturbed,   ///< likewise, but it adds no landmark
  kUnexplained  ///< do not use it
};

class DisturbanceResponse {
 public:
  /// Nearness of `estranged` [m]; updates in a row without explanation before the pose is lost.
  /// Throws std::invalid_argument unless `near_landmark` >= 0 and `lost_after` >= 1.
  DisturbanceResponse(Disturbance policy, double near_landmark, int lost_after);

  /// To be called before the correction; may inflate the covariance and associate anew.
  Doubt answer(const RespondingFilter& filter, const AssociatedObservation& observation);

  bool disturbed() const { return policy_.lasts(); }
  /// The last `answer` began a disturbance.
  bool began() const { return policy_.began(); }
  bool lost() const { return unexplained_ >= lost_after_; }
  /// The last `answer` lost the pose.
  bool became_lost() const { return unexplained_ == lost_after_; }
  /// The pose has been found by other means.
  void found();

 private:
  bool estranged(const RespondingFilter& filter, const AssociatedObservation& observation) const;
  /// Innovations that count: those the gate rejected only where they are many.
  std::span<const LinearizedMeasurement> evidence(const AssociatedObservation& observation) const;
  Doubt inflate(const RespondingFilter& filter);
  Doubt search(const RespondingFilter& filter);
  bool plausible(const RespondingFilter& filter, const AssociatedObservation& observation,
                 double scale);
  Doubt settle_on(bool explained);

  Disturbance policy_;
  double near_landmark_;
  int lost_after_;
  int unexplained_ = 0;
  JointInnovation joint_;
};

}  // namespace libslam
