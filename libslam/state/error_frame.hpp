#pragma once
// The error that the covariance describes, and how a correction moves the estimate.
//
// Models and stores always speak the additive (standard) error  delta = x - x_hat. An error frame
// defines another error xi with delta = T(x_hat) xi, T linear in xi. Keeping P in delta and
// applying
//     propagate:  P <- F P F^T + Q                      (same as T' F_xi T^-1 in xi)
//     correct:    delta = K nu  ->  xi = T(x-)^-1 delta, x+ = x- [+] xi  (exact retraction)
//                 P <- T(x+) T(x-)^-1 P (T(x+) T(x-)^-1)^T
// is the same filter as one that keeps the covariance of xi, at the cost of one low-rank change of
// chart per correction, which the store joins with the correction itself, and none in propagation.
// Derivation: libslam/README.md, section "Error frames".

#include <memory>
#include <string_view>

#include <Eigen/Core>

#include <libslam/state/gaussian_state.hpp>

namespace libslam {

class ErrorFrame {
 public:
  virtual ~ErrorFrame() = default;
  virtual std::string_view name() const = 0;
  /// Throws std::invalid_argument naming the block if this frame is not derived for it.
  virtual void require_supported(const BlockSpec& spec) const = 0;
  /// Moves every estimate by the additive correction `delta` (length: state dimension), which was
  /// computed at the current estimate. Returns T(x+) T(x-)^-1, which the caller applies to the
  /// covariance; valid until the next call. `pose` is the block whose heading carries the rotation
  /// of the world error.
  [[nodiscard]] virtual ChartChange retract(GaussianState& state, BlockId pose,
                                            const VectorRef& delta) = 0;
};

/// delta added to every block: the EKF of the textbooks.
class StandardFrame final : public ErrorFrame {
 public:
  std::string_view name() const override { return "standard"; }
  void require_supported(const BlockSpec&) const override {}
  ChartChange retract(GaussianState& state, BlockId pose, const VectorRef& delta) override;
};

/// Right-invariant error of SE_{1+n}(2) or SE_{1+n}(3): the orientation of the pose, its position p
/// and every world point m share the rotation of the world,
///     plane  xi_theta = delta_theta,  xi_p = delta_p - J p delta_theta,  xi_m alike
///     space  xi_theta = delta_theta,  xi_p = delta_p + p x delta_theta,  xi_m alike
/// with J the rotation by +90 degrees; blocks without a world role keep the additive error. Along
/// the unobservable directions (a shift and a turn of the world) xi does not depend on the
/// estimate, so the filter cannot gain information on them (Barrau & Bonnabel 2015,
/// arXiv:1510.06263). A planar pose turns points in space about the vertical and leaves their
/// heights alone. A delayed pose takes part as a point with an orientation of its own, whose error
/// stays additive: a turn of the world changes it by the same rotation everywhere, so the
/// directions stay constant. A line n(alpha)^T p = r is turned and shifted with the world,
///     xi_alpha = delta_alpha,  xi_r = delta_r - n(alpha)^T xi_p,
/// a shift of the world moves xi_p alone then, and a turn xi_theta and every xi_alpha by the same.
class RightInvariantFrame final : public ErrorFrame {
 public:
  std::string_view name() const override { return "right_invariant"; }
  /// Supported: SE2 and SE3 poses, points in the plane and in space, lines in the plane, blocks
  /// without a world role.
  void require_supported(const BlockSpec& spec) const override;
  /// Throws std::invalid_argument where a pose in space meets a planar block.
  ChartChange retract(GaussianState& state, BlockId pose, const VectorRef& delta) override;

 private:
  ChartChange retract_planar(GaussianState& state, BlockId pose, const VectorRef& delta);
  ChartChange retract_spatial(GaussianState& state, BlockId pose, const VectorRef& delta);
  /// A zero matrix of `columns` columns over the whole state, in the workspace.
  Eigen::Map<Eigen::MatrixXd> cleared(Eigen::Index dimension, Eigen::Index columns);

  // U, stacked: J (p+ - p-), or -[p+ - p-], of every world position; (n+ - n-)^T [I, -J p-] of r.
  Eigen::VectorXd moved_;
};

/// "standard" or "right_invariant"; throws std::invalid_argument otherwise.
std::unique_ptr<ErrorFrame> make_error_frame(std::string_view name);

}  // namespace libslam
