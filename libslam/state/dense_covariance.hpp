#pragma once
// The reference covariance store: one dense matrix of which only the lower triangle is kept.

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/state/covariance_store.hpp>

namespace libslam {

/// Symmetry holds by construction, because the upper triangle does not exist. A correction costs
/// n^2 (m + 2d) / 2 multiply-adds in one pass over P (symmetric_kernel.hpp), m rows observed and d
/// columns of the change of chart; where most coordinates are considered, as in localization, n (m
/// + 2d) for each of the others. Propagation touches only the rows of the block that moves. Grows
/// by doubling; within the capacity nothing allocates.
class DenseCovariance final : public CovarianceStore {
 public:
  std::unique_ptr<CovarianceStore> clone() const override;
  Eigen::Index dimension() const override { return n_; }
  void reserve(Eigen::Index dimension) override;
  void assign(const MatrixRef& cov) override;
  void propagate(Eigen::Index offset, std::span<const PlacedJacobian> wrt,
                 const BlockMatrix& cov_noise) override;
  void add_noise(Eigen::Index offset, const BlockMatrix& cov_noise) override;
  void augment(std::span<const PlacedJacobian> wrt, const BlockMatrix& cov_noise) override;
  void remove(Eigen::Index offset, Eigen::Index size) override;
  void couple(Eigen::Index row, Eigen::Index col, const BlockMatrix& cross) override;
  void project(std::span<const JacobianRows> rows, Eigen::Ref<Eigen::MatrixXd> out) const override;
  void observe(std::span<const JacobianRows> rows, Eigen::Ref<Eigen::MatrixXd> out) override;
  void gain(const Eigen::Ref<const Eigen::MatrixXd>& lower, const VectorRef& white,
            std::span<const Eigen::Index> considered, Eigen::Ref<Eigen::VectorXd> dx) override;
  void spread(const MatrixRef& root, const VectorRef& white, std::span<const Eigen::Index> kept,
              Eigen::Ref<Eigen::VectorXd> dx) override;
  void correct(const ChartChange& change) override;
  void marginal(Eigen::Index row, Eigen::Index col, Eigen::Ref<Eigen::MatrixXd> out) const override;

 private:
  double at(Eigen::Index row, Eigen::Index col) const {
    return row >= col ? p_(row, col) : p_(col, row);
  }
  /// W(:, first_column + r) += sum_c jacobian(r, c) P(:, offset + c), columns of P completed by
  /// symmetry; W is `gain_`.
  void gather(const PlacedJacobian& part, Eigen::Index first_column);
  /// P J^T of a whole Jacobian with the given number of rows, in the columns of W from
  /// `first_column`.
  void gather(std::span<const PlacedJacobian> wrt, Eigen::Index rows, Eigen::Index first_column);
  /// Appends the factors of T P' T^T - P' to those of P' = P - W W^T, so that P -= left right^T is
  /// both; returns the number of columns.
  Eigen::Index append(const ChartChange& change);
  /// True where most coordinates are considered and stay in place; fills `learns_`.
  bool mostly_considered(const ChartChange& change);
  /// Ends a correction with P -= left right^T but for the covariance of the considered coordinates
  /// with each other.
  void subtract_learning(const Eigen::MatrixXd& right, Eigen::Index columns);
  void reserve_gain(Eigen::Index columns);
  void require_inside(Eigen::Index offset, Eigen::Index size, const char* operation) const;

  Eigen::MatrixXd p_;  // capacity x capacity, lower triangle of the leading n_ x n_ part
  // Workspace, padded for the kernels: W and what follows it as left and right factors.
  Eigen::MatrixXd gain_, right_;
  std::vector<Eigen::Index> considered_;
  std::vector<bool> learns_;  // by coordinate: not considered
  Eigen::VectorXd product_;
  std::vector<double> kept_;  // covariance of the considered coordinates during a correction
  Eigen::Index n_ = 0;
  Eigen::Index observed_ = 0;  // columns of W that wait for `correct`
};

}  // namespace libslam
