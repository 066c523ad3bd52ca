#include <algorithm>
#include <stdexcept>
#include <string>

#include <libslam/state/dense_covariance.hpp>
#include <libslam/state/symmetric_kernel.hpp>

namespace libslam {

namespace {

using Eigen::Index;

Index padded(Index n) {
  return (n + kKernelTile - 1) / kKernelTile * kKernelTile;
}

[[noreturn]] void throw_dimension(const char* operation, const std::string& what) {
  throw std::invalid_argument(std::string("DenseCovariance::") + operation + ": " + what);
}

}  // namespace

std::unique_ptr<CovarianceStore> DenseCovariance::clone() const {
  return std::make_unique<DenseCovariance>(*this);
}

void DenseCovariance::require_inside(Index offset, Index size, const char* operation) const {
  if (offset < 0 || size < 0 || offset + size > n_)
    throw_dimension(operation, "coordinates [" + std::to_string(offset) + ", " +
                                   std::to_string(offset + size) + ") are outside the dimension " +
                                   std::to_string(n_));
}

void DenseCovariance::reserve(Index dimension) {
  if (dimension <= p_.rows()) return;
  const Index capacity = padded(std::max(dimension, 2 * p_.rows()));
  Eigen::MatrixXd grown(capacity, capacity);
  grown.topLeftCorner(n_, n_) = p_.topLeftCorner(n_, n_);
  p_ = std::move(grown);
  reserve_gain(std::max<Index>(gain_.cols(), 1));
}

void DenseCovariance::reserve_gain(Index columns) {
  if (gain_.rows() >= p_.rows() && gain_.cols() >= columns) return;
  const Index wanted = columns > gain_.cols() ? std::max(columns, 2 * gain_.cols()) : gain_.cols();
  gain_.resize(p_.rows(), wanted);
  whitened_.resize(wanted);
}

void DenseCovariance::add_column(Index col, double factor, double* out) const {
  const double* row = p_.data() + col;
  const Index stride = p_.rows();
  for (Index i = 0; i < col; ++i) out[i] += factor * row[i * stride];
  const double* column = p_.data() + col * stride;
  for (Index i = col; i < n_; ++i) out[i] += factor * column[i];
}

void DenseCovariance::gather(std::span<const PlacedJacobian> wrt, Index first_column) {
  const Index rows = wrt.empty() ? 0 : wrt.front().jacobian.rows();
  gain_.block(0, first_column, padded(n_), rows).setZero();
  for (const auto& [offset, jacobian] : wrt)
    for (Index r = 0; r < rows; ++r)
      for (Index c = 0; c < jacobian.cols(); ++c)
        if (const double factor = jacobian(r, c); factor != 0.0)
          add_column(offset + c, factor, gain_.col(first_column + r).data());
}

void DenseCovariance::propagate(Index offset, std::span<const PlacedJacobian> wrt,
                                const BlockMatrix& cov_noise) {
  const Index d = cov_noise.rows();
  require_inside(offset, d, "propagate");
  for (const auto& column : wrt) {
    require_inside(column.offset, column.jacobian.cols(), "propagate");
    if (column.jacobian.rows() != d)
      throw_dimension("propagate", "Jacobian has " + std::to_string(column.jacobian.rows()) +
                                       " rows, noise has " + std::to_string(d));
  }
  reserve_gain(d);
  gather(wrt, 0);
  // Covariance of the moved block before its rows are overwritten: sum_b C_b J_b^T + Q.
  BlockMatrix moved = cov_noise;
  for (const auto& [from, jacobian] : wrt)
    moved += gain_.block(from, 0, jacobian.cols(), d).transpose().lazyProduct(jacobian.transpose());
  for (Index r = 0; r < d; ++r) {
    for (Index i = 0; i < offset; ++i) p_(offset + r, i) = gain_(i, r);
    p_.col(offset + r).segment(offset + d, n_ - offset - d) =
        gain_.col(r).segment(offset + d, n_ - offset - d);
    for (Index c = 0; c <= r; ++c) p_(offset + r, offset + c) = 0.5 * (moved(r, c) + moved(c, r));
  }
}

void DenseCovariance::add_noise(Index offset, const BlockMatrix& cov_noise) {
  require_inside(offset, cov_noise.rows(), "add_noise");
  p_.block(offset, offset, cov_noise.rows(), cov_noise.rows()) += cov_noise;
}

void DenseCovariance::augment(std::span<const PlacedJacobian> wrt, const BlockMatrix& cov_noise) {
  const Index d = cov_noise.rows();
  for (const auto& column : wrt) {
    require_inside(column.offset, column.jacobian.cols(), "augment");
    if (column.jacobian.rows() != d)
      throw_dimension("augment", "Jacobian has " + std::to_string(column.jacobian.rows()) +
                                     " rows, noise has " + std::to_string(d));
  }
  reserve(n_ + d);
  reserve_gain(d);
  gather(wrt, 0);
  if (wrt.empty()) gain_.block(0, 0, padded(n_), d).setZero();
  BlockMatrix own = cov_noise;
  for (const auto& [from, jacobian] : wrt)
    own += gain_.block(from, 0, jacobian.cols(), d).transpose().lazyProduct(jacobian.transpose());
  for (Index r = 0; r < d; ++r) {
    for (Index i = 0; i < n_; ++i) p_(n_ + r, i) = gain_(i, r);
    for (Index c = 0; c <= r; ++c) p_(n_ + r, n_ + c) = 0.5 * (own(r, c) + own(c, r));
  }
  n_ += d;
}

void DenseCovariance::remove(Index offset, Index size) {
  require_inside(offset, size, "remove");
  const Index behind = n_ - offset - size;
  for (Index c = 0; c < offset; ++c)
    for (Index i = 0; i < behind; ++i) p_(offset + i, c) = p_(offset + size + i, c);
  for (Index c = 0; c < behind; ++c)
    for (Index i = c; i < behind; ++i)
      p_(offset + i, offset + c) = p_(offset + size + i, offset + size + c);
  n_ -= size;
}

void DenseCovariance::project(std::span<const JacobianRows> rows,
                              Eigen::Ref<Eigen::MatrixXd> out) const {
  out.setZero();
  for (const auto& a : rows)
    for (const auto& b : rows) {
      if (b.first_row > a.first_row) continue;
      for (const auto& ja : a.columns)
        for (const auto& jb : b.columns)
          for (Index c = 0; c < jb.jacobian.cols(); ++c)
            for (Index k = 0; k < ja.jacobian.cols(); ++k) {
              const double p = at(ja.offset + k, jb.offset + c);
              for (Index s = 0; s < b.rows; ++s) {
                const double right = p * jb.jacobian(s, c);
                for (Index r = 0; r < a.rows; ++r)
                  out(a.first_row + r, b.first_row + s) += ja.jacobian(r, k) * right;
              }
            }
    }
  out.triangularView<Eigen::StrictlyUpper>() = out.transpose();
}

void DenseCovariance::correct(std::span<const JacobianRows> rows,
                              const Eigen::Ref<const Eigen::MatrixXd>& lower,
                              const VectorRef& innovation, std::span<const Index> considered,
                              Eigen::Ref<Eigen::VectorXd> dx) {
  const Index m = lower.rows();
  if (innovation.size() != m || dx.size() != n_)
    throw_dimension("correct", "innovation has length " + std::to_string(innovation.size()) +
                                   " for " + std::to_string(m) + " rows, dx " +
                                   std::to_string(dx.size()) + " for dimension " +
                                   std::to_string(n_));
  reserve_gain(m);
  for (const auto& row : rows) {
    for (const auto& column : row.columns)
      require_inside(column.offset, column.jacobian.cols(), "correct");
    gather(row.columns, row.first_row);
  }
  // W = P H^T L^-T and y = L^-1 nu by forward substitution over the columns; dx = W y, P -= W W^T.
  const Index n = padded(n_);
  dx.setZero();
  for (Index k = 0; k < m; ++k) {
    auto column = gain_.col(k).head(n);
    double y = innovation[k];
    for (Index l = 0; l < k; ++l) {
      column -= lower(k, l) * gain_.col(l).head(n);
      y -= lower(k, l) * whitened_[l];
    }
    column /= lower(k, k);
    whitened_[k] = y / lower(k, k);
    dx += whitened_[k] * column.head(n_);
  }
  kept_.clear();
  for (const Index i : considered)
    for (const Index j : considered) kept_.push_back(at(i, j));
  subtract_outer_product(p_.data(), p_.rows(), n_, gain_.data(), gain_.rows(), m);
  auto kept = kept_.begin();
  for (const Index i : considered) {
    dx[i] = 0.0;
    for (const Index j : considered) p_(std::max(i, j), std::min(i, j)) = *kept++;
  }
}

void DenseCovariance::transport(Index offset, const Eigen::Ref<const Eigen::MatrixXd>& u) {
  const Index d = u.cols();
  require_inside(offset, d, "transport");
  if (u.rows() != n_)
    throw_dimension("transport", "U has " + std::to_string(u.rows()) + " rows for dimension " +
                                     std::to_string(n_));
  // (I + U E^T) P (I + U E^T)^T = P + U B^T + B U^T with B = P E + U (E^T P E) / 2.
  reserve_gain(d);
  gain_.leftCols(d).topRows(n_).setZero();
  for (Index k = 0; k < d; ++k) add_column(offset + k, 1.0, gain_.col(k).data());
  BlockMatrix half(d, d);
  for (Index r = 0; r < d; ++r)
    for (Index c = 0; c < d; ++c) half(r, c) = 0.5 * at(offset + r, offset + c);
  for (Index k = 0; k < d; ++k)
    for (Index l = 0; l < d; ++l) gain_.col(k).head(n_) += half(l, k) * u.col(l);
  for (Index k = 0; k < d; ++k) {
    const auto b = gain_.col(k).head(n_);
    for (Index c = 0; c < n_; ++c)
      p_.col(c).segment(c, n_ - c) += b[c] * u.col(k).tail(n_ - c) + u(c, k) * b.tail(n_ - c);
  }
}

void DenseCovariance::marginal(Index row, Index col, Eigen::Ref<Eigen::MatrixXd> out) const {
  require_inside(row, out.rows(), "marginal");
  require_inside(col, out.cols(), "marginal");
  for (Index c = 0; c < out.cols(); ++c)
    for (Index r = 0; r < out.rows(); ++r) out(r, c) = at(row + r, col + c);
}

}  // namespace libslam
