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
  Index capacity = padded(std::max(dimension, 2 * p_.rows()));
  // Columns a power of two apart would share a few sets of the cache.
  if (capacity / kKernelTile % 2 == 0) capacity += kKernelTile;
  Eigen::MatrixXd grown = Eigen::MatrixXd::Zero(capacity, capacity);
  grown.topLeftCorner(n_, n_) = p_.topLeftCorner(n_, n_);
  p_ = std::move(grown);
  reserve_gain(std::max<Index>(gain_.cols(), 1));
}

void DenseCovariance::reserve_gain(Index columns) {
  if (gain_.rows() >= p_.rows() && gain_.cols() >= columns) return;
  const Index wanted = columns > gain_.cols() ? std::max(columns, 2 * gain_.cols()) : gain_.cols();
  gain_.resize(p_.rows(), wanted);
  right_.resize(p_.rows(), wanted);
}

void DenseCovariance::gather(const PlacedJacobian& part, Index first_column) {
  const Index offset = part.offset, rows = part.jacobian.rows(), cols = part.jacobian.cols();
  const Index behind = offset + cols;
  // Before the block, its columns are rows of the stored triangle: one visit to each cache line.
  for (Index i = 0; i < offset; ++i) {
    const double* p = &p_(offset, i);
    for (Index r = 0; r < rows; ++r) {
      double sum = 0.0;
      for (Index c = 0; c < cols; ++c) sum += part.jacobian(r, c) * p[c];
      gain_(i, first_column + r) += sum;
    }
  }
  for (Index i = offset; i < behind; ++i)
    for (Index r = 0; r < rows; ++r)
      for (Index c = 0; c < cols; ++c)
        gain_(i, first_column + r) += part.jacobian(r, c) * at(i, offset + c);
  for (Index c = 0; c < cols; ++c)
    for (Index r = 0; r < rows; ++r)
      if (const double factor = part.jacobian(r, c); factor != 0.0)
        gain_.col(first_column + r).segment(behind, n_ - behind) +=
            factor * p_.col(offset + c).segment(behind, n_ - behind);
}

void DenseCovariance::gather(std::span<const PlacedJacobian> wrt, Index rows, Index first_column) {
  gain_.block(0, first_column, padded(n_), rows).setZero();
  for (const PlacedJacobian& part : wrt) gather(part, first_column);
}

void DenseCovariance::assign(const MatrixRef& cov) {
  if (cov.rows() != n_ || cov.cols() != n_)
    throw_dimension("assign", "matrix is " + std::to_string(cov.rows()) + " x " +
                                  std::to_string(cov.cols()) + " for dimension " +
                                  std::to_string(n_));
  p_.topLeftCorner(n_, n_).triangularView<Eigen::Lower>() = cov;
  observed_ = 0;
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
  observed_ = 0;
  reserve_gain(d);
  gather(wrt, d, 0);
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
  observed_ = 0;
  reserve_gain(d);
  gather(wrt, d, 0);
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
  observed_ = 0;
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

void DenseCovariance::observe(std::span<const JacobianRows> rows, Eigen::Ref<Eigen::MatrixXd> out) {
  const Index m = out.rows();
  reserve_gain(m + 2 * kMaxTangent);
  for (const auto& row : rows) {
    for (const auto& column : row.columns)
      require_inside(column.offset, column.jacobian.cols(), "observe");
    if (row.first_row < 0 || row.first_row + row.rows > m)
      throw_dimension("observe", "rows [" + std::to_string(row.first_row) + ", " +
                                     std::to_string(row.first_row + row.rows) +
                                     ") are outside the " + std::to_string(m) + " of the result");
    gather(row.columns, row.rows, row.first_row);
  }
  out.setZero();
  for (const auto& a : rows)
    for (const auto& b : rows) {
      if (b.first_row > a.first_row) continue;
      for (const auto& [offset, jacobian] : a.columns)
        out.block(a.first_row, b.first_row, a.rows, b.rows) +=
            jacobian.lazyProduct(gain_.block(offset, b.first_row, jacobian.cols(), b.rows));
    }
  out.triangularView<Eigen::StrictlyUpper>() = out.transpose();
  observed_ = m;
}

void DenseCovariance::gain(const Eigen::Ref<const Eigen::MatrixXd>& lower, const VectorRef& white,
                           std::span<const Index> considered, Eigen::Ref<Eigen::VectorXd> dx) {
  const Index m = observed_;
  if (lower.rows() != m || white.size() != m || dx.size() != n_)
    throw_dimension("gain", "factor of " + std::to_string(lower.rows()) +
                                " rows and innovation of " + std::to_string(white.size()) +
                                " for " + std::to_string(m) + " rows observed, dx " +
                                std::to_string(dx.size()) + " for dimension " + std::to_string(n_));
  // W = P H^T L^-T, so that dx = W y with y = L^-1 nu and P -= W W^T.
  symmetric_kernels().front().divide(
      {gain_.data(), gain_.rows(), n_, lower.data(), lower.outerStride(), m});
  dx.noalias() = gain_.topLeftCorner(n_, m) * white;
  considered_.assign(considered.begin(), considered.end());
  for (const Index i : considered_) {
    require_inside(i, 1, "gain");
    dx[i] = 0.0;
  }
}

Index DenseCovariance::append(const ChartChange& change) {
  const auto& u = change.u;
  const Index m = observed_, d = u.cols(), n = padded(n_);
  require_inside(change.offset, d, "correct");
  if (u.rows() != n_)
    throw_dimension("correct", "U has " + std::to_string(u.rows()) + " rows for dimension " +
                                   std::to_string(n_));
  for (const Index i : considered_)
    if (i >= change.offset && i < change.offset + d)
      throw_dimension("correct", "coordinate " + std::to_string(i) + " is considered");
  // T P' T^T = P' + U B^T + B U^T with B = P' E + U (E^T P' E) / 2.
  auto left_u = gain_.block(0, m, n, d), left_b = gain_.block(0, m + d, n, d);
  left_u.setZero();
  left_u.topRows(n_) = u;
  const PlacedJacobian e{change.offset, BlockMatrix::Identity(d, d)};
  gather(std::span(&e, 1), d, m + d);
  for (Index k = 0; k < d; ++k)
    for (Index j = 0; j < m; ++j)
      left_b.col(k) -= gain_(change.offset + k, j) * gain_.col(j).head(n);
  const BlockMatrix half = 0.5 * left_b.middleRows(change.offset, d);
  left_b += left_u.lazyProduct(half);
  right_.topLeftCorner(n, m) = gain_.topLeftCorner(n, m);
  right_.block(0, m, n, d) = -left_b;
  right_.block(0, m + d, n, d) = -left_u;
  return m + 2 * d;
}

bool DenseCovariance::mostly_considered(const ChartChange& change) {
  if (2 * static_cast<Index>(considered_.size()) <= n_) return false;
  learns_.assign(static_cast<std::size_t>(n_), true);
  for (const Index i : considered_) {
    learns_[static_cast<std::size_t>(i)] = false;
    if (change.u.cols() > 0 && !change.u.row(i).isZero(0.0)) return false;
  }
  return true;
}

void DenseCovariance::subtract_learning(const Eigen::MatrixXd& right, Index columns) {
  if (product_.size() < p_.rows()) product_.resize(p_.rows());
  for (Index j = 0; j < n_; ++j) {
    if (!learns_[static_cast<std::size_t>(j)]) continue;
    product_.head(n_).noalias() =
        gain_.topLeftCorner(n_, columns) * right.row(j).head(columns).transpose();
    for (Index i = 0; i < j; ++i)
      if (!learns_[static_cast<std::size_t>(i)]) p_(j, i) -= product_[i];
    p_.col(j).segment(j, n_ - j) -= product_.segment(j, n_ - j);
  }
  observed_ = 0;
}

void DenseCovariance::correct(const ChartChange& change) {
  const bool moves = change.u.cols() > 0;
  if (observed_ == 0) {
    considered_.clear();
    reserve_gain(2 * change.u.cols());
  }
  const Index columns = moves ? append(change) : observed_;
  const Eigen::MatrixXd& right = moves ? right_ : gain_;
  if (observed_ > 0 && mostly_considered(change)) return subtract_learning(right, columns);
  kept_.clear();
  for (const Index i : considered_)
    for (const Index j : considered_) kept_.push_back(at(i, j));
  symmetric_kernels().front().subtract(
      {p_.data(), p_.rows(), n_, gain_.data(), right.data(), gain_.rows(), columns});
  auto kept = kept_.begin();
  for (const Index i : considered_)
    for (const Index j : considered_) {
      double& p = p_(std::max(i, j), std::min(i, j));
      p = *kept++;
      for (Index k = observed_; k < columns; ++k) p -= gain_(i, k) * right(j, k);
    }
  observed_ = 0;
}

void DenseCovariance::marginal(Index row, Index col, Eigen::Ref<Eigen::MatrixXd> out) const {
  require_inside(row, out.rows(), "marginal");
  require_inside(col, out.cols(), "marginal");
  for (Index c = 0; c < out.cols(); ++c)
    for (Index r = 0; r < out.rows(); ++r) out(r, c) = at(row + r, col + c);
}

}  // namespace libslam
