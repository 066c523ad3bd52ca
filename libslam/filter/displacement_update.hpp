#pragma once
// Corrections by a sensor that measures its own displacement: a delayed pose block as a part of the
// filter.
//
// At every reading the pose is cloned into the state. The next reading measures the displacement
// between the clone and the pose then; afterwards the clone is marginalized and the pose cloned
// anew, whether the displacement was used or gated. Between readings any number of motions may
// pass. The clone is exact and linear (Jacobian I, no noise), so that the correlation with every
// calibration block through the motion in between is kept to first order.

#include <memory>
#include <optional>
#include <span>

#include <libslam/filter/ekf.hpp>
#include <libslam/measurement/displacement_model.hpp>

namespace libslam {

/// What a reading did.
struct DisplacementOutcome {
  bool measured = false;  ///< there was an earlier reading to measure from
  Correction correction;  ///< applied: within the gate and used
};

class DisplacementUpdate {
 public:
  /// `gate`: largest squared Mahalanobis distance (3 degrees of freedom) of a displacement that is
  /// used. Throws std::invalid_argument if `model` is null.
  DisplacementUpdate(std::unique_ptr<DisplacementModel> model, double gate);

  const DisplacementModel& model() const { return *model_; }

  /// `blocks`: calibration of the model. `pose` is the reference pose of the error frame.
  DisplacementOutcome apply(GaussianState& state, Ekf& ekf, BlockId pose,
                            const CalibrationBlocks& blocks, std::span<const BlockId> considered,
                            const Feature& reading);

 private:
  std::unique_ptr<DisplacementModel> model_;
  double gate_;
  std::optional<BlockId> before_;  // the clone
  Feature reading_;                // taken there
  LinearizedMeasurement measurement_;
};

}  // namespace libslam
