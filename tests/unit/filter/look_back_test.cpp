// What a correction leaves behind, against dense algebra.

#include <random>
#include <tests/support/random_matrix.hpp>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/filter/ekf.hpp>

using namespace libslam;
using libslam::testing::random_covariance;
using libslam::testing::random_matrix;

namespace {

constexpr Eigen::Index kStates = 9;  // three blocks of three

/// Measurements of one to four rows of a state of three blocks, each seeing two of them.
struct Problem {
  GaussianState state;
  BlockId pose;
  std::vector<LinearizedMeasurement> measurements;
  Eigen::MatrixXd h, r;  // stacked, and block diagonal
  Eigen::VectorXd nu;

  Problem(const std::vector<int>& rows, std::mt19937_64& random) {
    pose = state.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, Eigen::Vector3d::Zero(),
                     random_covariance(3, random));
    std::vector<BlockId> blocks{pose};
    for (const char* name : {"a", "b"})
      blocks.push_back(state.add({name, Chart::kVector, 3}, random_matrix(3, 1, random),
                                 random_covariance(3, random)));
    Eigen::Index m = 0;
    for (const int d : rows) m += d;
    h = Eigen::MatrixXd::Zero(m, kStates);
    r = Eigen::MatrixXd::Zero(m, m);
    nu = random_matrix(m, 1, random);
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Eigen::Index d = rows[i];
      LinearizedMeasurement& measurement = measurements.emplace_back();
      measurement.innovation = nu.segment(row, d);
      measurement.cov = random_covariance(d, random);
      r.block(row, row, d, d) = measurement.cov;
      for (const std::size_t which : {i % 3, (i + 1) % 3}) {
        const Eigen::MatrixXd jacobian = random_matrix(d, 3, random);
        measurement.wrt.add(blocks[which], d, 3) = jacobian;
        h.block(row, 3 * static_cast<Eigen::Index>(which), d, 3) = jacobian;
      }
      row += d;
    }
  }
};

}  // namespace

TEST(LookBack, IsWhatDenseAlgebraSays) {
  std::mt19937_64 random(53);
  for (const std::vector<int>& rows : {std::vector<int>{2},
                                       {2, 2, 2},
                                       {1, 4, 3, 2},
                                       std::vector<int>(12, 2),
                                       std::vector<int>(23, 3)}) {
    Problem problem(rows, random);
    const Eigen::MatrixXd before = problem.state.full_covariance();
    Ekf ekf(make_error_frame("standard"));
    ASSERT_TRUE(ekf.correct(problem.state, problem.pose, problem.measurements).applied);
    std::vector<Postfit> postfits;
    ekf.look_back(problem.measurements, postfits);
    const Eigen::MatrixXd after = problem.state.full_covariance();
    const Eigen::MatrixXd predicted = problem.h * before * problem.h.transpose();
    const Eigen::MatrixXd s = predicted + problem.r;
    const Eigen::VectorXd residual = problem.r * s.ldlt().solve(problem.nu);
    const Eigen::MatrixXd left = problem.h * after * problem.h.transpose();
    ASSERT_EQ(postfits.size(), rows.size());
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Eigen::Index d = rows[i];
      // Rounding: entries of some tens, S with a condition of at most a few thousand.
      const double tolerance = 1e-10;
      EXPECT_EQ(postfits[i].innovation, problem.nu.segment(row, d));
      EXPECT_LT((postfits[i].cov_innovation - s.block(row, row, d, d)).norm(), tolerance);
      const Eigen::MatrixXd r = problem.measurements[i].cov;
      EXPECT_LT((r * postfits[i].weighted - residual.segment(row, d)).norm(), tolerance);
      EXPECT_LT((r - r * postfits[i].information * r - left.block(row, row, d, d)).norm(),
                tolerance);
      row += d;
    }
  }
}

TEST(LookBack, WeighingAgainWithAnotherNoiseIsAsIfItHadBeenThereAtFirst) {
  std::mt19937_64 random(54);
  Problem problem({2, 3, 1}, random), again = problem;
  Ekf ekf(make_error_frame("standard"));
  ASSERT_TRUE(ekf.weigh(again.state, again.measurements));
  EXPECT_EQ(again.state.full_covariance(), problem.state.full_covariance());
  for (Problem* one : {&problem, &again})
    for (LinearizedMeasurement& measurement : one->measurements) measurement.cov *= 4.0;
  ASSERT_TRUE(ekf.weigh(again.state, again.measurements));
  const Correction twice = ekf.solve(again.state);
  ekf.apply(again.state, again.pose);
  const Correction once = ekf.correct(problem.state, problem.pose, problem.measurements);
  EXPECT_EQ(twice.nis, once.nis);
  EXPECT_EQ(twice.dof, 6);
  EXPECT_EQ(again.state.full_covariance(), problem.state.full_covariance());
}
