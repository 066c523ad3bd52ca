// Every kernel that this machine can run against the same operation of Eigen.

#include <algorithm>
#include <limits>
#include <random>
#include <tests/support/random_matrix.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/state/symmetric_kernel.hpp>

using namespace libslam;
using libslam::testing::random_covariance;
using libslam::testing::random_matrix;

namespace {

// Rounding of about m * eps on entries of order 1.
constexpr double kRounding = 1e-13;
constexpr Eigen::Index kColumns = 6;

/// `x` in a larger matrix as the kernels want it; what lies beyond is `filling`.
Eigen::MatrixXd padded(const Eigen::MatrixXd& x, Eigen::Index columns, double filling) {
  const Eigen::Index rows = (x.rows() + kKernelTile - 1) / kKernelTile * kKernelTile;
  Eigen::MatrixXd out = Eigen::MatrixXd::Constant(rows, std::max(rows, columns), filling);
  out.topLeftCorner(x.rows(), x.cols()) = x;
  return out;
}

}  // namespace

class KernelSizes : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(AroundTheTiles, KernelSizes,
                         ::testing::Values(1, 3, 7, 8, 9, 15, 16, 17, 31, 50));

TEST_P(KernelSizes, SubtractTouchesTheLowerTriangleAlone) {
  const Eigen::Index n = GetParam();
  std::mt19937_64 random(16);
  const Eigen::MatrixXd c = random_matrix(n, kColumns, random);
  // A B^T = c c^T is symmetric though A and B differ.
  const Eigen::MatrixXd a = padded(2.0 * c, kColumns, 0.0), b = padded(0.5 * c, kColumns, 0.0);
  const Eigen::MatrixXd full = random_covariance(n, random), expected = full - c * c.transpose();
  Eigen::MatrixXd before = padded(full, 0, 7.0);
  before.triangularView<Eigen::StrictlyUpper>().setConstant(
      std::numeric_limits<double>::infinity());
  for (const SymmetricKernels& kernels : symmetric_kernels()) {
    Eigen::MatrixXd p = before;
    kernels.subtract({p.data(), p.rows(), n, a.data(), b.data(), a.rows(), kColumns});
    const Eigen::MatrixXd error = p.topLeftCorner(n, n) - expected;
    EXPECT_LT(error.triangularView<Eigen::Lower>().toDenseMatrix().cwiseAbs().maxCoeff(), kRounding)
        << kernels.name;
    for (Eigen::Index j = 0; j < p.cols(); ++j)
      for (Eigen::Index i = 0; i < j; ++i)
        EXPECT_EQ(p(i, j), before(i, j)) << kernels.name << " at " << i << ", " << j;
  }
}

TEST_P(KernelSizes, DivideSolvesWithTheTransposedFactor) {
  const Eigen::Index n = GetParam();
  std::mt19937_64 random(17);
  const Eigen::MatrixXd lower = random_covariance(kColumns, random).llt().matrixL();
  const Eigen::MatrixXd product = random_matrix(n, kColumns, random);
  const Eigen::MatrixXd dividend = product * lower.transpose();
  Eigen::MatrixXd factor = lower;
  factor.triangularView<Eigen::StrictlyUpper>().setConstant(
      std::numeric_limits<double>::quiet_NaN());
  for (const SymmetricKernels& kernels : symmetric_kernels()) {
    Eigen::MatrixXd w = padded(dividend, kColumns, 0.0);
    kernels.divide({w.data(), w.rows(), n, factor.data(), factor.rows(), kColumns});
    // The condition of the factor, about 10, multiplies the rounding.
    EXPECT_LT((w.topLeftCorner(n, kColumns) - product).cwiseAbs().maxCoeff(), 100 * kRounding)
        << kernels.name;
  }
}

TEST(SymmetricKernels, TheBaselineIsAlwaysThere) {
  ASSERT_FALSE(symmetric_kernels().empty());
  EXPECT_STREQ(symmetric_kernels().back().name, "baseline");
}
