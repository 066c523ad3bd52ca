// Every operation of the store against the same operation written with full matrices.

#include <random>
#include <tests/support/random_matrix.hpp>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/state/dense_covariance.hpp>

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

/// T = I + U E^T, E the unit columns from `offset`.
Eigen::MatrixXd chart_matrix(Eigen::Index offset, const Eigen::MatrixXd& u) {
  Eigen::MatrixXd t = Eigen::MatrixXd::Identity(u.rows(), u.rows());
  t.middleCols(offset, u.cols()) += u;
  return t;
}

ChartChange chart_change(Eigen::Index offset, const Eigen::MatrixXd& u) {
  return {offset, {u.data(), u.rows(), u.cols()}};
}

/// All of a correction; returns dx.
Eigen::VectorXd correct(DenseCovariance& dense, const std::vector<JacobianRows>& rows,
                        const Eigen::MatrixXd& r, const Eigen::VectorXd& nu,
                        const std::vector<Eigen::Index>& considered = {},
                        const ChartChange& change = {}) {
  Eigen::MatrixXd s(nu.size(), nu.size());
  dense.observe(rows, s);
  const Eigen::MatrixXd lower = (s + r).llt().matrixL();
  Eigen::VectorXd dx(dense.dimension());
  dense.gain(lower, lower.triangularView<Eigen::Lower>().solve(nu), considered, dx);
  dense.correct(change);
  return dx;
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

  Eigen::MatrixXd projected(4, 4), observed(4, 4);
  store.dense.project(rows, projected);
  EXPECT_LT(error(projected, h * store.full * h.transpose()), kRounding);
  store.dense.observe(rows, observed);
  EXPECT_LT(error(observed, projected), kRounding);
  EXPECT_LT(error(store.matrix(), store.full), kRounding);

  const Eigen::MatrixXd s = projected + r;
  const Eigen::MatrixXd k = store.full * h.transpose() * s.inverse();
  const Eigen::MatrixXd i_kh = Eigen::MatrixXd::Identity(n, n) - k * h;
  const Eigen::MatrixXd joseph = i_kh * store.full * i_kh.transpose() + k * r * k.transpose();
  const Eigen::VectorXd dx = correct(store.dense, rows, r, nu);
  EXPECT_LT(error(store.matrix(), joseph), kRounding * 10);
  EXPECT_LT((dx - k * nu).cwiseAbs().maxCoeff(), kRounding * 10);
}

TEST_P(DenseCovarianceSizes, SpreadTakesInformationBack) {
  std::mt19937_64 random(17);
  const Eigen::Index n = GetParam();
  Store store(random_covariance(n, random));
  const std::vector<PlacedJacobian> first{{0, BlockMatrix::Identity(2, 2)}},
      last{{n - 2, BlockMatrix::Identity(2, 2)}};
  Eigen::MatrixXd s(4, 4), b(n, 4);
  store.dense.observe(std::vector<JacobianRows>{{0, 2, first}, {2, 2, last}}, s);
  b << store.full.leftCols(2), store.full.rightCols(2);
  b.row(2).setZero();  // kept
  const Eigen::MatrixXd root = random_matrix(4, 3, random);
  const Eigen::VectorXd white = random_matrix(3, 1, random);
  Eigen::VectorXd dx(n);
  store.dense.spread(root, white, std::vector<Eigen::Index>{2}, dx);
  EXPECT_LT((dx - b * root * white).cwiseAbs().maxCoeff(), kRounding * 10);
  const Eigen::MatrixXd expected = store.full + b * root * root.transpose() * b.transpose();
  EXPECT_LT(error(store.matrix(), expected), kRounding * 10);
  const Eigen::MatrixXd u = random_matrix(n, 1, random), t = chart_matrix(1, u);
  store.dense.correct(chart_change(1, u));
  EXPECT_LT(error(store.matrix(), t * expected * t.transpose()), kRounding * 100);
}

TEST_P(DenseCovarianceSizes, CoupleSetsACrossCovariance) {
  std::mt19937_64 random(18);
  const Eigen::Index n = GetParam();
  Store store(random_covariance(n, random));
  Eigen::MatrixXd expected = store.full;
  for (const bool below : {true, false}) {
    const BlockMatrix cross = random_matrix(1, 3, random);
    const Eigen::Index row = below ? n - 1 : 0, col = below ? 0 : n - 3;
    expected.block(row, col, 1, 3) = cross;
    expected.block(col, row, 3, 1) = cross.transpose();
    store.dense.couple(row, col, cross);
    EXPECT_LT(error(store.matrix(), expected), kRounding);
  }
  EXPECT_THROW(store.dense.couple(1, 0, BlockMatrix::Zero(1, 3)), std::invalid_argument);
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
  // The change of chart reads coordinate 2 and moves all.
  const Eigen::MatrixXd u = random_matrix(n, 1, random);
  const Eigen::MatrixXd t = chart_matrix(2, u);
  const Eigen::VectorXd dx =
      correct(store.dense, {{0, 2, columns}}, r, nu, considered, chart_change(2, u));
  EXPECT_LT(error(store.matrix(), t * joseph * t.transpose()), kRounding * 100);
  EXPECT_LT((dx - k * nu).cwiseAbs().maxCoeff(), kRounding * 10);
}

// As in localization: all but the pose and one more coordinate are considered, and the change of
// chart leaves them in place.
TEST_P(DenseCovarianceSizes, MostCoordinatesMayBeConsidered) {
  std::mt19937_64 random(19);
  const Eigen::Index n = GetParam(), other = n - 2;
  Store store(random_covariance(n, random));
  const std::vector<PlacedJacobian> columns = {{0, random_matrix(2, 3, random)},
                                               {n - 1, random_matrix(2, 1, random)}};
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(2, n);
  h.leftCols(3) = columns[0].jacobian;
  h.rightCols(1) = columns[1].jacobian;
  const Eigen::MatrixXd r = random_covariance(2, random);
  Eigen::MatrixXd k = store.full * h.transpose() * (h * store.full * h.transpose() + r).inverse();
  Eigen::MatrixXd u = random_matrix(n, 1, random);
  std::vector<Eigen::Index> considered;
  for (Eigen::Index i = 3; i < n; ++i)
    if (i != other) {
      considered.push_back(i);
      k.row(i).setZero();
      u.row(i).setZero();
    }
  const Eigen::MatrixXd i_kh = Eigen::MatrixXd::Identity(n, n) - k * h;
  const Eigen::MatrixXd joseph = i_kh * store.full * i_kh.transpose() + k * r * k.transpose();
  const Eigen::MatrixXd t = chart_matrix(2, u);
  const Eigen::VectorXd nu = random_matrix(2, 1, random);
  const Eigen::MatrixXd before = store.matrix();
  const Eigen::VectorXd dx =
      correct(store.dense, {{0, 2, columns}}, r, nu, considered, chart_change(2, u));
  EXPECT_LT(error(store.matrix(), t * joseph * t.transpose()), kRounding * 100);
  EXPECT_LT((dx - k * nu).cwiseAbs().maxCoeff(), kRounding * 10);
  for (const Eigen::Index i : considered)
    for (const Eigen::Index j : considered) EXPECT_EQ(store.matrix()(i, j), before(i, j));
}

TEST_P(DenseCovarianceSizes, AssignReplacesAll) {
  std::mt19937_64 random(20);
  const Eigen::Index n = GetParam();
  Store store(random_covariance(n, random));
  Eigen::MatrixXd other = random_covariance(static_cast<int>(n), random);
  other = other.selfadjointView<Eigen::Lower>();
  store.dense.assign(other);
  EXPECT_EQ(store.matrix(), other);
  EXPECT_THROW(store.dense.assign(Eigen::MatrixXd::Zero(n + 1, n + 1)), std::invalid_argument);
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

TEST_P(DenseCovarianceSizes, ChangeOfChartIsACongruence) {
  std::mt19937_64 random(14);
  const Eigen::Index n = GetParam();
  const Store store(random_covariance(n, random));
  const Eigen::MatrixXd u = random_matrix(n, 2, random);
  const Eigen::MatrixXd t = chart_matrix(2, u);
  Store alone = store;
  alone.dense.correct(chart_change(2, u));
  EXPECT_LT(error(alone.matrix(), t * store.full * t.transpose()), kRounding * 100);

  // In one pass with a correction, and not again without a new one.
  const std::vector<PlacedJacobian> columns = {{1, random_matrix(2, 3, random)}};
  const Eigen::MatrixXd r = random_covariance(2, random);
  Store separate = store, joint = store;
  correct(separate.dense, {{0, 2, columns}}, r, Eigen::Vector2d::Ones());
  const Eigen::MatrixXd corrected = separate.matrix();
  correct(joint.dense, {{0, 2, columns}}, r, Eigen::Vector2d::Ones(), {}, chart_change(2, u));
  const Eigen::MatrixXd moved = joint.matrix();
  EXPECT_LT(error(moved, t * corrected * t.transpose()), kRounding * 100);
  joint.dense.correct({});
  EXPECT_EQ(joint.matrix(), moved);
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

TEST(DenseCovariance, NamesTheOffendingDimension) {
  std::mt19937_64 random(17);
  Store store(random_covariance(5, random));
  EXPECT_THROW(store.dense.remove(4, 2), std::invalid_argument);
  EXPECT_THROW(store.dense.add_noise(-1, BlockMatrix::Identity(2, 2)), std::invalid_argument);
  EXPECT_THROW(store.dense.correct(chart_change(0, Eigen::VectorXd::Ones(4))),
               std::invalid_argument);
  EXPECT_THROW(correct(store.dense, {}, Eigen::Matrix2d::Identity(), Eigen::Vector2d::Zero(), {2},
                       chart_change(2, Eigen::VectorXd::Ones(5))),
               std::invalid_argument);
  try {
    store.dense.propagate(0, std::vector<PlacedJacobian>{{0, BlockMatrix::Identity(3, 3)}},
                          BlockMatrix::Identity(2, 2));
    FAIL() << "a 3-row Jacobian with a 2 x 2 noise must be refused";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("3 rows"), std::string::npos) << e.what();
  }
}
