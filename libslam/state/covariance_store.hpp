#pragma once
// The contract of covariance storage. A store owns the symmetric matrix P of the whole state and
// the operations a filter needs; how it keeps P is its own affair.
//
// Given a symmetric positive semi-definite P, every operation leaves P symmetric; `correct` and
// `remove` never allocate, the others only when the dimension grows beyond the reserved capacity.
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

class CovarianceStore {
 public:
  virtual ~CovarianceStore() = default;
  virtual std::unique_ptr<CovarianceStore> clone() const = 0;

  virtual Eigen::Index dimension() const = 0;
  /// Makes room for `dimension` coordinates so that growing up to it does not allocate.
  virtual void reserve(Eigen::Index dimension) = 0;

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

  /// out = H P H^T of the stacked rows, full symmetric matrix.
  virtual void project(std::span<const JacobianRows> rows,
                       Eigen::Ref<Eigen::MatrixXd> out) const = 0;
  /// Kalman correction with S = L L^T the covariance of the innovation nu of the stacked rows:
  /// dx = P H^T S^-1 nu, P <- P - P H^T S^-1 H P. `lower` is L; nothing above its diagonal is read.
  /// The coordinates in `considered` count with their uncertainty but do not learn: their dx is
  /// zero and their covariance with each other stays (Schmidt-Kalman; Schmidt 1966).
  virtual void correct(std::span<const JacobianRows> rows,
                       const Eigen::Ref<const Eigen::MatrixXd>& lower, const VectorRef& innovation,
                       std::span<const Eigen::Index> considered,
                       Eigen::Ref<Eigen::VectorXd> dx) = 0;
  /// P <- (I + U E^T) P (I + U E^T)^T, E the unit columns of [offset, offset + U.cols()): the
  /// change of chart of an error frame.
  virtual void transport(Eigen::Index offset, const Eigen::Ref<const Eigen::MatrixXd>& u) = 0;

  /// out = the block at rows [row, row + out.rows()), columns [col, col + out.cols()).
  virtual void marginal(Eigen::Index row, Eigen::Index col,
                        Eigen::Ref<Eigen::MatrixXd> out) const = 0;
};

}  // namespace libslam
