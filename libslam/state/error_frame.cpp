#include <cmath>
#include <stdexcept>
#include <string>

#include <libslam/state/error_frame.hpp>

namespace libslam {

namespace {

Eigen::Vector2d rotated_90(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

/// Exponential map of SE(2) acting on one position: p -> R(theta) p + V(theta) xi.
class PlanarExponential {
 public:
  explicit PlanarExponential(double theta) : cosine_(std::cos(theta)), sine_(std::sin(theta)) {
    const bool small = std::abs(theta) < 1e-5;
    sinc_ = small ? 1.0 - theta * theta / 6.0 : sine_ / theta;
    versine_ = small ? 0.5 * theta : (1.0 - cosine_) / theta;
  }
  Eigen::Vector2d operator()(const Eigen::Vector2d& p, const Eigen::Vector2d& xi) const {
    return {cosine_ * p.x() - sine_ * p.y() + sinc_ * xi.x() - versine_ * xi.y(),
            sine_ * p.x() + cosine_ * p.y() + versine_ * xi.x() + sinc_ * xi.y()};
  }

 private:
  double cosine_, sine_, sinc_ = 1.0, versine_ = 0.0;
};

void require_length(const GaussianState& state, const VectorRef& delta) {
  if (delta.size() != state.dimension())
    throw std::invalid_argument("correction has length " + std::to_string(delta.size()) +
                                ", the state has dimension " + std::to_string(state.dimension()));
}

void add_to_block(const GaussianState::MutableBlock& block, const VectorRef& delta) {
  auto x = block.estimate;
  boxplus(block.spec, x, delta.segment(block.offset, block.size));
}

}  // namespace

ChartChange StandardFrame::retract(GaussianState& state, BlockId, const VectorRef& delta) {
  require_length(state, delta);
  for (const BlockId block : state.blocks()) add_to_block(state.mutable_block(block), delta);
  return {};
}

void RightInvariantFrame::require_supported(const BlockSpec& spec) const {
  const bool planar_point =
      spec.role == WorldRole::kPoint && spec.chart == Chart::kVector && spec.size == 2;
  const bool planar_pose = spec.role == WorldRole::kPose && spec.chart == Chart::kSE2;
  if (spec.role == WorldRole::kNone || planar_point || planar_pose) return;
  throw std::invalid_argument("block '" + spec.name +
                              "': the right-invariant error frame is derived for SE(2) poses and "
                              "planar points only");
}

ChartChange RightInvariantFrame::retract(GaussianState& state, BlockId pose,
                                         const VectorRef& delta) {
  require_length(state, delta);
  const Eigen::Index heading = state.offset(pose) + 2;
  const double turn = delta[heading];
  const PlanarExponential exponential(turn);
  if (moved_.size() < state.dimension()) moved_.resize(2 * state.dimension());
  moved_.head(state.dimension()).setZero();
  for (const BlockId id : state.blocks()) {
    GaussianState::MutableBlock block = state.mutable_block(id);
    const WorldRole role = block.spec.role;
    if (role == WorldRole::kNone) {
      add_to_block(block, delta);
      continue;
    }
    auto& x = block.estimate;
    // xi = -J x turn is the turn about the origin taken back: what has no correction stays,
    // exactly.
    if (role == WorldRole::kPoint && delta.segment<2>(block.offset).isZero(0.0)) continue;
    const Eigen::Vector2d before = x.head<2>();
    const Eigen::Vector2d xi = delta.segment<2>(block.offset) - rotated_90(before) * turn;
    const Eigen::Vector2d after = exponential(before, xi);
    x.head<2>() = after;
    if (role == WorldRole::kPose) x[2] = wrap_angle(x[2] + delta[block.offset + 2]);
    moved_.segment<2>(block.offset) = rotated_90(after - before);
  }
  return {heading, {moved_.data(), state.dimension(), 1}};
}

std::unique_ptr<ErrorFrame> make_error_frame(std::string_view name) {
  if (name == "standard") return std::make_unique<StandardFrame>();
  if (name == "right_invariant") return std::make_unique<RightInvariantFrame>();
  throw std::invalid_argument("unknown error frame '" + std::string(name) + "'");
}

}  // namespace libslam
