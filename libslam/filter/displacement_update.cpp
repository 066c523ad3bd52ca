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
  clone(state, pose);
  reading_ = reading;
  return outcome;
}

void DisplacementUpdate::clone(GaussianState& state, BlockId pose) {
  identity_.estimate = state.estimate(pose);
  identity_.wrt.clear();
  identity_.wrt.add(pose, 3, 3).setIdentity();
  identity_.cov_noise.setZero(3, 3);
  before_ = state.augment({"pose_before", Chart::kSE2, 3, WorldRole::kPose}, identity_);
}

}  // namespace libslam
