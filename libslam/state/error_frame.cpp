#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <libslam/state/error_frame.hpp>
#include <libslam/state/so3.hpp>

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

/// A point without a correction: its xi takes back the turn about the origin, exactly, and the
/// exponential leaves it where it is. A line, too: it turns back about its own point and slides
/// along itself.
bool stays(const GaussianState::MutableBlock& block, const VectorRef& delta) {
  const WorldRole role = block.spec.role;
  return (role == WorldRole::kPoint || role == WorldRole::kLine) &&
         delta.segment(block.offset, block.size).isZero(0.0);
}

bool has_lines(const GaussianState& state) {
  return std::ranges::any_of(
      state.blocks(), [&](BlockId block) { return state.spec(block).role == WorldRole::kLine; });
}

Eigen::Vector2d direction(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

ChartChange StandardFrame::retract(GaussianState& state, BlockId, const VectorRef& delta) {
  require_length(state, delta);
  for (const BlockId block : state.blocks()) add_to_block(state.mutable_block(block), delta);
  return {};
}

void RightInvariantFrame::require_supported(const BlockSpec& spec) const {
  const bool point = spec.role == WorldRole::kPoint && spec.chart == Chart::kVector &&
                     (spec.size == 2 || spec.size == 3);
  const bool pose =
      spec.role == WorldRole::kPose && (spec.chart == Chart::kSE2 || spec.chart == Chart::kSE3);
  const bool line = spec.role == WorldRole::kLine && spec.chart == Chart::kLine;
  if (spec.role == WorldRole::kNone || point || pose || line) return;
  throw std::invalid_argument("block '" + spec.name +
                              "': the right-invariant error frame is derived for SE(2) and SE(3) "
                              "poses, for points and for planar lines only");
}

ChartChange RightInvariantFrame::retract(GaussianState& state, BlockId pose,
                                         const VectorRef& delta) {
  require_length(state, delta);
  return state.spec(pose).chart == Chart::kSE3 ? retract_spatial(state, pose, delta)
                                               : retract_planar(state, pose, delta);
}

Eigen::Map<Eigen::MatrixXd> RightInvariantFrame::cleared(Eigen::Index dimension,
                                                         Eigen::Index columns) {
  if (moved_.size() < dimension * columns) moved_.resize(2 * dimension * columns);
  Eigen::Map<Eigen::MatrixXd> u(moved_.data(), dimension, columns);
  u.setZero();
  return u;
}

ChartChange RightInvariantFrame::retract_planar(GaussianState& state, BlockId pose,
                                                const VectorRef& delta) {
  // Without lines the change of chart has the column of the heading alone.
  const Eigen::Index first = state.offset(pose), columns = has_lines(state) ? 3 : 1;
  const double turn = delta[first + 2];
  const PlanarExponential exponential(turn);
  const Eigen::Vector2d p = state.estimate(pose).head<2>();
  auto u = cleared(state.dimension(), columns);
  for (const BlockId id : state.blocks()) {
    GaussianState::MutableBlock block = state.mutable_block(id);
    const WorldRole role = block.spec.role;
    if (role == WorldRole::kNone) {
      add_to_block(block, delta);
      continue;
    }
    auto& x = block.estimate;
    if (stays(block, delta)) continue;
    if (role == WorldRole::kLine) {
      // By its own turn: a line that does not turn must not creep with the turn of the robot.
      const double own_turn = delta[block.offset];
      const Eigen::Vector2d shift = delta.segment<2>(first) - rotated_90(p) * own_turn;
      const Eigen::Vector2d before = direction(x[0]);
      x[0] = wrap_angle(x[0] + own_turn);
      const Eigen::Vector2d after = direction(x[0]);
      x[1] += delta[block.offset + 1] - before.dot(shift) +
              after.dot(PlanarExponential(own_turn)(Eigen::Vector2d::Zero(), shift));
      const Eigen::Vector2d change = after - before;
      u.row(block.offset + 1) << change.transpose(), -change.dot(rotated_90(p));
      continue;
    }
    const Eigen::Vector2d before = x.head<2>();
    const Eigen::Vector2d xi = delta.segment<2>(block.offset) - rotated_90(before) * turn;
    const Eigen::Vector2d after = exponential(before, xi);
    x.head<2>() = after;
    if (block.size == 3) x[2] += delta[block.offset + 2];
    if (role == WorldRole::kPose) x[2] = wrap_angle(x[2]);
    u.col(columns - 1).segment<2>(block.offset) = rotated_90(after - before);
  }
  return {first + 3 - columns, {moved_.data(), state.dimension(), columns}};
}

ChartChange RightInvariantFrame::retract_spatial(GaussianState& state, BlockId pose,
                                                 const VectorRef& delta) {
  const Eigen::Index first = state.offset(pose) + 3;
  const Eigen::Vector3d theta = delta.segment<3>(first);
  const Eigen::Matrix3d R = so3_exp(theta).toRotationMatrix(), V = so3_left_jacobian(theta);
  auto u = cleared(state.dimension(), 3);
  for (const BlockId id : state.blocks()) {
    GaussianState::MutableBlock block = state.mutable_block(id);
    const WorldRole role = block.spec.role;
    if (role == WorldRole::kNone) {
      add_to_block(block, delta);
      continue;
    }
    if (block.spec.chart == Chart::kSE2 || block.size < 3)
      throw std::invalid_argument("block '" + block.spec.name +
                                  "' is planar, the robot moves in space");
    if (stays(block, delta)) continue;
    auto& x = block.estimate;
    const Eigen::Vector3d before = x.head<3>();
    const Eigen::Vector3d xi = delta.segment<3>(block.offset) + before.cross(theta);
    const Eigen::Vector3d after = R * before + V * xi;
    if (role == WorldRole::kPose) add_to_block(block, delta);
    x.head<3>() = after;
    u.middleRows<3>(block.offset) = skew(before - after);
  }
  return {first, {moved_.data(), state.dimension(), 3}};
}

std::unique_ptr<ErrorFrame> make_error_frame(std::string_view name) {
  if (name == "standard") return std::make_unique<StandardFrame>();
  if (name == "right_invariant") return std::make_unique<RightInvariantFrame>();
  throw std::invalid_argument("unknown error frame '" + std::string(name) + "'");
}

}  // namespace libslam
