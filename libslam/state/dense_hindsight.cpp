// What DenseCovariance does for those who change their mind about the past.

#include <stdexcept>

#include <libslam/state/dense_covariance.hpp>
#include <libslam/state/symmetric_kernel.hpp>

namespace libslam {

using Eigen::Index;

void DenseCovariance::couple(Index row, Index col, const BlockMatrix& cross) {
  require_inside(row, cross.rows(), "couple");
  require_inside(col, cross.cols(), "couple");
  if (row < col + cross.cols() && col < row + cross.rows())
    throw std::invalid_argument("DenseCovariance::couple: the coordinates overlap");
  for (Index c = 0; c < cross.cols(); ++c)
    for (Index r = 0; r < cross.rows(); ++r)
      (row > col ? p_(row + r, col + c) : p_(col + c, row + r)) = cross(r, c);
}

void DenseCovariance::spread(const MatrixRef& root, const VectorRef& white,
                             std::span<const Index> kept, Eigen::Ref<Eigen::VectorXd> dx) {
  const Index m = observed_, k = root.cols();
  if (root.rows() != m || white.size() != k || k > m || dx.size() != n_)
    throw std::invalid_argument("DenseCovariance::spread: a root of " +
                                std::to_string(root.rows()) + " x " + std::to_string(k) + " for " +
                                std::to_string(m) + " rows observed");
  const Index n = gain_.rows();
  right_.topLeftCorner(n, k).noalias() = gain_.topLeftCorner(n, m) * root;
  for (const Index i : kept) {
    require_inside(i, 1, "spread");
    right_.row(i).head(k).setZero();
  }
  dx.noalias() = right_.topLeftCorner(n_, k) * white;
  gain_.topLeftCorner(n, k) = -right_.topLeftCorner(n, k);
  symmetric_kernels().front().subtract(
      {p_.data(), p_.rows(), n_, gain_.data(), right_.data(), gain_.rows(), k});
  observed_ = 0;
}

}  // namespace libslam
