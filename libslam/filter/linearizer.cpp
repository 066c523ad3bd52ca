#include <stdexcept>
#include <utility>
#include <vector>

#include <libslam/filter/linearizer.hpp>

namespace libslam {

namespace {

/// The state at the points of linearization of some blocks, for as long as this lives.
class Elsewhere {
 public:
  Elsewhere(GaussianState& state, const LinearizationPoint& point) : state_(state), point_(point) {}
  ~Elsewhere() {
    for (const auto& [block, estimate] : kept_) state_.set_estimate(block, estimate);
  }
  Elsewhere(const Elsewhere&) = delete;
  Elsewhere& operator=(const Elsewhere&) = delete;

  void move(BlockId block) {
    const BlockVector* const value = point_.find(block);
    if (value == nullptr) return;
    kept_.emplace_back(block, state_.estimate(block));
    state_.set_estimate(block, *value);
  }

 private:
  GaussianState& state_;
  const LinearizationPoint& point_;
  std::vector<std::pair<BlockId, BlockVector>> kept_;
};

}  // namespace

void Linearizer::require_supported(const BlockSpec& landmark) const {
  const bool planar_point =
      landmark.role == WorldRole::kPoint && landmark.chart == Chart::kVector && landmark.size == 2;
  if (point_ && !planar_point)
    throw std::invalid_argument(
        "a point of linearization besides the estimate is derived for planar landmarks only");
}

void Linearizer::add_block(const GaussianState& state, BlockId block) {
  if (point_) point_->add_block(block, state.spec(block));
}

void Linearizer::linearize(const MotionModel& model, GaussianState& state, BlockId pose,
                           const CalibrationBlocks& blocks, const MotionAction& action,
                           MotionStep& step) {
  model.linearize(state, pose, blocks, action, step);
  if (!point_) return;
  Elsewhere elsewhere(state, *point_);
  elsewhere.move(pose);
  for (const BlockId block : blocks) elsewhere.move(block);
  model.linearize(state, pose, blocks, action, step_);
  step.wrt = step_.wrt;
  step.cov_noise = step_.cov_noise;
  reached_ = step_.estimate.head<2>();
}

void Linearizer::linearize(const MeasurementModel& model, GaussianState& state, BlockId pose,
                           BlockId landmark, const Feature& feature, LinearizedMeasurement& out) {
  model.linearize(state, pose, landmark, feature, out);
  if (!point_) return;
  Elsewhere elsewhere(state, *point_);
  elsewhere.move(pose);
  elsewhere.move(landmark);
  model.linearize(state, pose, landmark, feature, measurement_);
  out.wrt = measurement_.wrt;
}

void Linearizer::initialize(const MeasurementModel& model, GaussianState& state, BlockId pose,
                            const Feature& feature, Initialization& out) {
  model.initialize(state, pose, feature, out);
  if (!point_) return;
  Elsewhere elsewhere(state, *point_);
  elsewhere.move(pose);
  model.initialize(state, pose, feature, initialization_);
  out.wrt = initialization_.wrt;
  out.cov_noise = initialization_.cov_noise;
  reached_ = initialization_.estimate.head<2>();
}

void Linearizer::moved(GaussianState& state, BlockId pose) {
  if (point_) follow(state, pose, pose, point_->move(reached_));
}

void Linearizer::stood(GaussianState& state, BlockId pose) {
  if (!point_) return;
  const BlockVector* const value = point_->find(pose);
  reached_ = state.estimate(pose).head<2>();
  if (value != nullptr) reached_ = value->head<2>();
  moved(state, pose);
}

void Linearizer::corrected(GaussianState& state, BlockId pose, const Eigen::Vector2d& before) {
  if (point_) follow(state, pose, pose, point_->correct(before, state.estimate(pose).head<2>()));
}

void Linearizer::added(GaussianState& state, BlockId pose, BlockId landmark,
                       std::int64_t identity) {
  if (point_) follow(state, pose, landmark, point_->add_landmark(landmark, identity, reached_));
}

void Linearizer::follow(GaussianState& state, BlockId pose, BlockId block,
                        const Eigen::Vector2d& jump) {
  if (jump.isZero(0.0)) return;
  u_.setZero(state.dimension());
  u_.segment<2>(state.offset(block)) = Eigen::Vector2d(-jump.y(), jump.x());
  state.covariance().correct({state.offset(pose) + 2, {u_.data(), u_.size(), 1}});
}

}  // namespace libslam
