#pragma once
// The contract of covariance storage. A store owns the symmetric matrix P of the whole state and
// the operations a filter needs; how it keeps P is its own affair.
//
// Given a symmetric positive semi-definite P, every operation leaves P symmetric; `remove` never
// allocates, the others only when the dimension grows beyond the reserved capacity or more rows are
// observed at once than ever before.
// Offsets and lengths are tangent coordinates. Every operation throws std::invalid_argument that
// names the offending dimension.

#include <memory>
#include <span>

#include <Eigen/Core>

#include <libslam/state/block.hpp>

namespace libslam {

/// A block column of a Jacobian, by its place in the state.
struct PlacedJacobian {
  Eigen::Index offset = 0;
  BlockMatrix jacobian;
};

/// A block row of a stacked measurement Jacobian: rows of one measurement and their columns.
struct JacobianRows {
  Eigen::Index first_row = 0;
  Eigen::Index rows = 0;
  std::span<const PlacedJacobian> columns;
};

/// A change of the error that P describes: T = I + U E^T, E the unit columns of
/// [offset, offset + U.cols()). No change if U has no columns.
struct ChartChange {
  Eigen::Index offset = 0;
  Eigen::Map<const Eigen::MatrixXd> u{nullptr, 0, 0};  ///< state dimension x d, d <= kMaxTangent
};

class CovarianceStore {
 public:
  virtual ~CovarianceStore() = default;
  virtual std::unique_ptr<CovarianceStore> clone() const = 0;

  virtual Eigen::Index dimension() const = 0;
  /// Makes room for `dimension` coordinates so that growing up to it does not allocate.
  virtual void reserve(Eigen::Index dimension) = 0;

  /// P becomes `cov`, a full symmetric matrix of the dimension of the store; what a correction has
  /// left behind so far is void.
  virtual void assign(const MatrixRef& cov) = 0;
  /// Rows and columns [offset, offset + d) become those of sum_i J_i x_i + w, w ~ N(0, cov_noise),
  /// independent of the state. The rows that change may be among the columns of J.
  virtual void propagate(Eigen::Index offset, std::span<const PlacedJacobian> wrt,
                         const BlockMatrix& cov_noise) = 0;
  /// Adds `cov_noise` to the diagonal block at `offset`.
  virtual void add_noise(Eigen::Index offset, const BlockMatrix& cov_noise) = 0;
  /// Appends coordinates of sum_i J_i x_i + w, w ~ N(0, cov_noise).
  virtual void augment(std::span<const PlacedJacobian> wrt, const BlockMatrix& cov_noise) = 0;
  /// Removes the coordinates [offset, offset + size): marginalization.
  virtual void remove(Eigen::Index offset, Eigen::Index size) = 0;

  /// out = H P H^T of the stacked rows, full symmetric matrix. Meant for few rows.
  virtual void project(std::span<const JacobianRows> rows,
                       Eigen::Ref<Eigen::MatrixXd> out) const = 0;

  /// The covariance of [row, row + d) with [col, col + e) becomes `cross`; the two do not overlap.
  virtual void couple(Eigen::Index row, Eigen::Index col, const BlockMatrix& cross) = 0;

  // A correction takes three calls in this order, each using what the one before has left behind. P
  // changes in the last alone, in one pass; until then it can be given up.

  /// Remembers P H^T of the stacked rows; out = H P H^T, full symmetric matrix.
  virtual void observe(std::span<const JacobianRows> rows, Eigen::Ref<Eigen::MatrixXd> out) = 0;
  /// dx = P H^T S^-1 nu for the rows observed. `lower` is L with S = L L^T the covariance of the
  /// innovation nu, nothing above its diagonal is read; `white` is L^-1 nu. The coordinates in
  /// `considered` count with their uncertainty but do not learn: their dx is zero and their
  /// covariance with each other stays (Schmidt-Kalman; Schmidt 1966).
  virtual void gain(const Eigen::Ref<const Eigen::MatrixXd>& lower, const VectorRef& white,
                    std::span<const Eigen::Index> considered, Eigen::Ref<Eigen::VectorXd> dx) = 0;
  /// Instead of a gain, what takes information back: P <- P + W W^T and dx = W white with
  /// W = P H^T root for the rows observed, at most as many columns as rows; the coordinates in
  /// `kept` do not change. For the change of chart `correct` may follow.
  virtual void spread(const MatrixRef& root, const VectorRef& white,
                      std::span<const Eigen::Index> kept, Eigen::Ref<Eigen::VectorXd> dx) = 0;
  /// P <- T (P - P H^T S^-1 H P) T^T with T as `change` says; without a `gain` before, P <- T P
  /// T^T. The coordinates that `change` reads (E) must not be among the considered ones.
  virtual void correct(const ChartChange& change) = 0;

  /// out = the block at rows [row, row + out.rows()), columns [col, col + out.cols()).
  virtual void marginal(Eigen::Index row, Eigen::Index col,
                        Eigen::Ref<Eigen::MatrixXd> out) const = 0;
};

}  // namespace libslam
