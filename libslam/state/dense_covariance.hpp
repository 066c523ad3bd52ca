#pragma once
// The reference covariance store: one dense matrix of which only the lower triangle is kept.

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/state/covariance_store.hpp>

namespace libslam {

/// Symmetry holds by construction, because the upper triangle does not exist. A correction costs
/// n^2 m / 2 multiply-adds in one pass over P (symmetric_kernel.hpp); propagation touches only the
/// rows of the block that moves. Grows by doubling; within the capacity nothing allocates.
class DenseCovariance final : public CovarianceStore {
 public:
  std::unique_ptr<CovarianceStore> clone() const override;
  Eigen::Index dimension() const override { return n_; }
  void reserve(Eigen::Index dimension) override;
  void propagate(Eigen::Index offset, std::span<const PlacedJacobian> wrt,
                 const BlockMatrix& cov_noise) override;
  void add_noise(Eigen::Index offset, const BlockMatrix& cov_noise) override;
  void augment(std::span<const PlacedJacobian> wrt, const BlockMatrix& cov_noise) override;
  void remove(Eigen::Index offset, Eigen::Index size) override;
  void project(std::span<const JacobianRows> rows, Eigen::Ref<Eigen::MatrixXd> out) const override;
  void correct(std::span<const JacobianRows> rows, const Eigen::Ref<const Eigen::MatrixXd>& lower,
               const VectorRef& innovation, std::span<const Eigen::Index> considered,
               Eigen::Ref<Eigen::VectorXd> dx) override;
  void transport(Eigen::Index offset, const Eigen::Ref<const Eigen::MatrixXd>& u) override;
  void marginal(Eigen::Index row, Eigen::Index col, Eigen::Ref<Eigen::MatrixXd> out) const override;

 private:
  double at(Eigen::Index row, Eigen::Index col) const {
    return row >= col ? p_(row, col) : p_(col, row);
  }
  /// out(0..n-1) += factor * P.col(col), the column completed by symmetry.
  void add_column(Eigen::Index col, double factor, double* out) const;
  /// Columns of W in `gain_`: sum of P columns weighted by `wrt`, one column per Jacobian row.
  void gather(std::span<const PlacedJacobian> wrt, Eigen::Index first_column);
  void reserve_gain(Eigen::Index columns);
  void require_inside(Eigen::Index offset, Eigen::Index size, const char* operation) const;

  Eigen::MatrixXd p_;     // capacity x capacity, lower triangle of the leading n_ x n_ part
  Eigen::MatrixXd gain_;  // workspace, padded for the kernel
  Eigen::VectorXd whitened_;
  std::vector<double> kept_;  // covariance of the considered coordinates during a correction
  Eigen::Index n_ = 0;
};

}  // namespace libslam
