#include <stdexcept>

#include <libslam/filter/displacement_update.hpp>

namespace libslam {

DisplacementUpdate::DisplacementUpdate(std::unique_ptr<DisplacementModel> model, double gate)
    : model_(std::move(model)), gate_(gate) {
  if (!model_) throw std::invalid_argument("DisplacementUpdate needs a displacement model");
}

DisplacementOutcome DisplacementUpdate::apply(GaussianState& state, Ekf& ekf, BlockId pose,
                                              const CalibrationBlocks& blocks,
                                              std::span<const BlockId> considered,
                                              const Feature& reading) {
  DisplacementOutcome outcome;
  if (before_) {
    outcome.measured = true;
    model_->linearize(state, {*before_, pose}, blocks, reading_, reading, measurement_);
    if (ekf.innovate(state, measurement_).mahalanobis2 <= gate_)
      outcome.correction = ekf.correct(state, pose, {&measurement_, 1}, considered);
    state.remove(*before_);
  }
  before_ = state.clone(pose, "pose_before");
  reading_ = reading;
  return outcome;
}

}  // namespace libslam
