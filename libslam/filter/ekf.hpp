#pragma once
// The core: propagate, innovate, correct. It takes numbers, not models.
//
//   propagate   x <- f(x),  P <- F P F^T + Q                       (given f(x), F, Q)
//   innovate    S = H P H^T + R,  d^2 = nu^T S^-1 nu                (given nu, H, R)
//   correct     delta = P H^T S^-1 nu,  P <- P - P H^T S^-1 H P,  retraction by the error frame
//
// Symbols: libslam/README.md. S is factored by Cholesky; no matrix is inverted; P stays symmetric
// by construction. In steady state (no growth of state or observation count) a step does not
// allocate.

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/joint_innovation.hpp>
#include <libslam/data/postfit.hpp>
#include <libslam/state/block_evidence.hpp>
#include <libslam/state/error_frame.hpp>
#include <libslam/state/gaussian_state.hpp>
#include <libslam/state/linearization.hpp>

namespace libslam {

/// How well one measurement fits the state.
struct Innovation {
  double mahalanobis2 = 0.0;  ///< nu^T S^-1 nu
  double log_det = 0.0;       ///< log |S|
};

/// Outcome of a joint correction.
struct Correction {
  bool applied = false;  ///< false: S was not positive definite; the state is untouched
  double nis = 0.0;      ///< nu^T S^-1 nu of the stacked measurements
  int dof = 0;
};

class Ekf {
 public:
  /// Throws std::invalid_argument if `frame` is null.
  explicit Ekf(std::unique_ptr<ErrorFrame> frame);

  const ErrorFrame& frame() const { return *frame_; }

  /// Moves the target block of `step`. Throws std::invalid_argument naming the block and sizes when
  /// a Jacobian does not fit its block.
  void propagate(GaussianState& state, const MotionStep& step);

  /// Compatibility of one measurement with the state; the state is not changed. The distance is
  /// infinite where S is not positive definite.
  Innovation innovate(const GaussianState& state, const LinearizedMeasurement& measurement);

  /// The same of all measurements together, for those who judge them before a correction.
  void expect(const GaussianState& state, BlockId pose,
              std::span<const LinearizedMeasurement> measurements, JointInnovation& out);

  /// Joint update with all measurements stacked. `pose` is the reference pose of the error frame.
  /// Blocks in `considered` keep estimate and covariance, but their uncertainty counts. Derivatives
  /// with respect to constants of the state are left out.
  Correction correct(GaussianState& state, BlockId pose,
                     std::span<const LinearizedMeasurement> measurements,
                     std::span<const BlockId> considered = {});

  /// The three parts of `correct`, for those who look in between. `weigh` leaves the state alone
  /// and may be repeated, say with another R; false: S is not positive definite.
  bool weigh(GaussianState& state, std::span<const LinearizedMeasurement> measurements);
  /// After a `weigh` that succeeded: computes the step, and leaves the state alone, too.
  Correction solve(GaussianState& state, std::span<const BlockId> considered = {});
  /// Takes the step; nothing else may have happened to the covariance since `weigh`.
  void apply(GaussianState& state, BlockId pose);
  /// The step that was solved last: an additive error of the whole state. Valid until the next one.
  Eigen::Map<const Eigen::VectorXd> step() const { return {delta_.data(), step_size_}; }
  /// Moves the estimates alone by that step, as `apply` does; returns the change of the error that
  /// goes with it (ErrorFrame::retract).
  [[nodiscard]] ChartChange move(GaussianState& state, BlockId pose) const;

  /// Takes information back: P <- P + B M B^T, delta = B root white, with B the covariance of the
  /// state with `shadows` (filter/hindsight.hpp) and M = root root^T. The blocks in `kept` do not
  /// change.
  void spread(GaussianState& state, BlockId pose, std::span<const BlockId> shadows,
              const MatrixRef& root, const VectorRef& white, std::span<const BlockId> kept);

  /// After `weigh` or a correction that was applied, with the same measurements: each of them seen
  /// through the S of all, without the position of its feature.
  void look_back(std::span<const LinearizedMeasurement> measurements, std::vector<Postfit>& out);
  /// The same of one block: what the measurements said about it.
  BlockEvidence look_back(std::span<const LinearizedMeasurement> measurements, BlockId block,
                          Eigen::Index size);

 private:
  /// Stacks rows_ and nu_; returns the number of rows.
  Eigen::Index stack(const GaussianState& state,
                     std::span<const LinearizedMeasurement> measurements);
  /// Adds R to H P H^T, the leading m x m part of s_, and puts the Cholesky factor of the sum in
  /// its place; false if it is not positive definite.
  bool factorize(std::span<const LinearizedMeasurement> measurements, Eigen::Index m);
  /// nu^T S^-1 nu from the factor in s_; leaves L^-1 nu in white_.
  double squared_distance(Eigen::Index m);

  void reserve_divided(Eigen::Index m);
  void invert_factor(Eigen::Index m);
  template <int kDiagonals>
  void invert_blocks(Eigen::Index m);

  std::unique_ptr<ErrorFrame> frame_;
  std::vector<PlacedJacobian> placed_;
  std::vector<JacobianRows> rows_;
  std::vector<Eigen::Index> considered_;
  std::vector<MeasurementMatrix> own_;  // diagonal blocks of S
  Eigen::MatrixXd s_;
  Eigen::MatrixXd divided_;    // L^-T, or L^-1 times the columns of one block; whole tiles
  Eigen::MatrixXd diagonals_;  // of S^-1: the main one, the one below it, ...
  Eigen::VectorXd nu_, white_, weighted_, delta_;
  Eigen::Index weighed_ = 0;  // rows
  Eigen::Index step_size_ = 0;
  double nis_ = 0.0;
};

}  // namespace libslam
