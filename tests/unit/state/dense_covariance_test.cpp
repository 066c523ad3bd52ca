// Every operation of the store against the same operation written with full matrices.

#include <random>
#include <tests/support/random_matrix.hpp>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/state/dense_covariance.hpp>
#include <libslam/state/symmetric_kernel.hpp>

using namespace libslam;
using libslam::testing::random_covariance;
using libslam::testing::random_matrix;

namespace {

// Rounding of about n * eps on entries of order 1 for n up to 200.
constexpr double kRounding = 1e-12;

struct Store {
  explicit Store(const Eigen::MatrixXd& p) : full(p) {
    // Appending scalars one by one: x_new = a^T x + w reproduces any covariance.
    for (Eigen::Index i = 0; i < p.rows(); ++i) {
      std::vector<PlacedJacobian> wrt;
      double own = p(i, i);
      if (i > 0) {
        const Eigen::VectorXd a = p.topLeftCorner(i, i).llt().solve(p.col(i).head(i));
        for (Eigen::Index k = 0; k < i; ++k) wrt.push_back({k, BlockMatrix::Constant(1, 1, a[k])});
        own -= a.dot(p.col(i).head(i));
      }
      dense.augment(wrt, BlockMatrix::Constant(1, 1, own));
    }
  }
  Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd out(dense.dimension(), dense.dimension());
    dense.marginal(0, 0, out);
    return out;
  }
  Eigen::MatrixXd full;
  DenseCovariance dense;
};

double error(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

}  // namespace

class DenseCovarianceSizes : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(AroundTheTiles, DenseCovarianceSizes,
                         ::testing::Values(5, 15, 16, 17, 33, 80));

TEST_P(DenseCovarianceSizes, AugmentBuildsAnyCovariance) {
  std::mt19937_64 random(11);
  const Store store(random_covariance(GetParam(), random));
  EXPECT_LT(error(store.matrix(), store.full), kRounding);
}

TEST_P(DenseCovarianceSizes, CorrectEqualsJosephForm) {
  std::mt19937_64 random(12);
  const Eigen::Index n = GetParam();
  Store store(random_covariance(n, random));
  // Two measurements of 2 rows that touch the first three coordinates and one other each.
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(4, n);
  std::vector<std::vector<PlacedJacobian>> columns(2);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto row = static_cast<Eigen::Index>(2 * i), other = n - 1 - static_cast<Eigen::Index>(i);
    columns[i] = {{0, random_matrix(2, 3, random)}, {other, random_matrix(2, 1, random)}};
    h.block(row, 0, 2, 3) = columns[i][0].jacobian;
    h.block(row, other, 2, 1) += columns[i][1].jacobian;
  }
  const std::vector<JacobianRows> rows = {{0, 2, columns[0]}, {2, 2, columns[1]}};
  const Eigen::MatrixXd r = random_covariance(4, random);
  const Eigen::VectorXd nu = random_matrix(4, 1, random);

  Eigen::MatrixXd projected(4, 4);
  store.dense.project(rows, projected);
  EXPECT_LT(error(projected, h * store.full * h.transpose()), kRounding);

  const Eigen::MatrixXd s = projected + r;
  const Eigen::MatrixXd k = store.full * h.transpose() * s.inverse();
  const Eigen::MatrixXd i_kh = Eigen::MatrixXd::Identity(n, n) - k * h;
  const Eigen::MatrixXd joseph = i_kh * store.full * i_kh.transpose() + k * r * k.transpose();
  Eigen::VectorXd dx(n);
  store.dense.correct(rows, s.llt().matrixL().toDenseMatrix(), nu, {}, dx);
  EXPECT_LT(error(store.matrix(), joseph), kRounding * 10);
  EXPECT_LT((dx - k * nu).cwiseAbs().maxCoeff(), kRounding * 10);
}

TEST_P(DenseCovarianceSizes, ConsideredCoordinatesDoNotLearn) {
  std::mt19937_64 random(18);
  const Eigen::Index n = GetParam();
  Store store(random_covariance(n, random));
  const std::vector<PlacedJacobian> columns = {{0, random_matrix(2, 3, random)}};
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(2, n);
  h.leftCols(3) = columns[0].jacobian;
  const Eigen::MatrixXd r = random_covariance(2, random);
  const Eigen::MatrixXd s = h * store.full * h.transpose() + r;
  const std::vector<Eigen::Index> considered = {1, n - 1};
  Eigen::MatrixXd k = store.full * h.transpose() * s.inverse();
  for (const Eigen::Index i : considered) k.row(i).setZero();
  // The Joseph form holds for any gain, also one with rows of zeros.
  const Eigen::MatrixXd i_kh = Eigen::MatrixXd::Identity(n, n) - k * h;
  const Eigen::MatrixXd joseph = i_kh * store.full * i_kh.transpose() + k * r * k.transpose();
  const Eigen::VectorXd nu = random_matrix(2, 1, random);
  Eigen::VectorXd dx(n);
  store.dense.correct(std::vector<JacobianRows>{{0, 2, columns}}, s.llt().matrixL().toDenseMatrix(),
                      nu, considered, dx);
  EXPECT_LT(error(store.matrix(), joseph), kRounding * 10);
  EXPECT_LT((dx - k * nu).cwiseAbs().maxCoeff(), kRounding * 10);
}

TEST_P(DenseCovarianceSizes, PropagateMovesRowsAndColumns) {
  std::mt19937_64 random(13);
  const Eigen::Index n = GetParam(), offset = n >= 15 ? 7 : 0;
  Store store(random_covariance(n, random));
  const BlockMatrix by_self = random_matrix(2, 2, random), by_last = random_matrix(2, 1, random);
  const BlockMatrix q = random_covariance(2, random);
  Eigen::MatrixXd f = Eigen::MatrixXd::Identity(n, n);
  f.block(offset, offset, 2, 2) = by_self;
  f.block(offset, n - 1, 2, 1) = by_last;
  Eigen::MatrixXd expected = f * store.full * f.transpose();
  expected.block(offset, offset, 2, 2) += q;
  store.dense.propagate(offset, std::vector<PlacedJacobian>{{offset, by_self}, {n - 1, by_last}},
                        q);
  EXPECT_LT(error(store.matrix(), expected), kRounding * 10);
}

TEST_P(DenseCovarianceSizes, TransportIsACongruence) {
  std::mt19937_64 random(14);
  const Eigen::Index n = GetParam();
  Store store(random_covariance(n, random));
  const Eigen::MatrixXd u = random_matrix(n, 2, random);
  Eigen::MatrixXd t = Eigen::MatrixXd::Identity(n, n);
  t.middleCols(2, 2) += u;
  store.dense.transport(2, u);
  EXPECT_LT(error(store.matrix(), t * store.full * t.transpose()), kRounding * 100);
}

TEST_P(DenseCovarianceSizes, RemoveMarginalizes) {
  std::mt19937_64 random(15);
  const Eigen::Index n = GetParam();
  Store store(random_covariance(n, random));
  store.dense.remove(1, 2);
  Eigen::MatrixXd expected(n - 2, n - 2);
  const Eigen::Index tail = n - 3;
  expected << store.full.topLeftCorner(1, 1), store.full.topRightCorner(1, tail),
      store.full.bottomLeftCorner(tail, 1), store.full.bottomRightCorner(tail, tail);
  EXPECT_LT(error(store.matrix(), expected), kRounding);
}

TEST(DenseCovariance, KernelTouchesTheLowerTriangleAlone) {
  std::mt19937_64 random(16);
  for (const Eigen::Index n : {1, 3, 16, 31, 50}) {
    Eigen::MatrixXd w = Eigen::MatrixXd::Zero((n + 15) / 16 * 16, 6);
    w.topRows(n) = random_matrix(n, 6, random);
    Eigen::MatrixXd p = random_covariance(n, random);
    const Eigen::MatrixXd before = p;
    subtract_outer_product(p.data(), n, n, w.data(), w.rows(), 6);
    const Eigen::MatrixXd expected = before - w.topRows(n) * w.topRows(n).transpose();
    EXPECT_LT((p - expected).triangularView<Eigen::Lower>().toDenseMatrix().cwiseAbs().maxCoeff(),
              kRounding);
    const Eigen::MatrixXd upper = (p - before).triangularView<Eigen::StrictlyUpper>();
    EXPECT_EQ(upper.cwiseAbs().maxCoeff(), 0.0);
  }
}

TEST(DenseCovariance, NamesTheOffendingDimension) {
  std::mt19937_64 random(17);
  Store store(random_covariance(5, random));
  EXPECT_THROW(store.dense.remove(4, 2), std::invalid_argument);
  EXPECT_THROW(store.dense.add_noise(-1, BlockMatrix::Identity(2, 2)), std::invalid_argument);
  try {
    store.dense.propagate(0, std::vector<PlacedJacobian>{{0, BlockMatrix::Identity(3, 3)}},
                          BlockMatrix::Identity(2, 2));
    FAIL() << "a 3-row Jacobian with a 2 x 2 noise must be refused";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("3 rows"), std::string::npos) << e.what();
  }
}
