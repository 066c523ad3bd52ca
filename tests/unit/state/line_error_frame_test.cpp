// Lines in the right-invariant error frame: xi_alpha = delta_alpha, xi_r = delta_r - n^T xi_p.

#include <random>
#include <tests/support/random_matrix.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/state/error_frame.hpp>

using namespace libslam;
using libslam::testing::random_covariance;
using libslam::testing::random_matrix;

namespace {

constexpr int kLines = 4;
// Pose, one calibration number, a point, lines; fully correlated.
constexpr Eigen::Index kDimension = 3 + 1 + 2 + 2 * kLines;

struct World {
  GaussianState state;
  BlockId pose;
};

World make_world(std::mt19937_64& random) {
  World world;
  world.pose = world.state.add({"pose", Chart::kSE2, 3, WorldRole::kPose},
                               random_matrix(3, 1, random, 2.0), random_covariance(3, random));
  Initialization block;
  const auto add = [&](const BlockSpec& spec, Eigen::Index size, double spread) {
    block.wrt.clear();
    block.estimate = random_matrix(size, 1, random, spread);
    block.wrt.add(world.pose, size, 3) = random_matrix(size, 3, random);
    block.cov_noise = random_covariance(size, random);
    world.state.augment(spec, block);
  };
  add({"scale", Chart::kVector, 1, WorldRole::kNone}, 1, 1.0);
  add({"point", Chart::kVector, 2, WorldRole::kPoint}, 2, 10.0);
  for (int i = 0; i < kLines; ++i) add({"", Chart::kLine, 2, WorldRole::kLine}, 2, 3.0);
  return world;
}

Eigen::Vector2d direction(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

Eigen::Vector2d left_of(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

/// delta = T(x) xi, written out from the definition in the header.
Eigen::MatrixXd chart_change(const World& world) {
  const GaussianState& state = world.state;
  Eigen::MatrixXd t = Eigen::MatrixXd::Identity(kDimension, kDimension);
  for (const BlockId block : state.blocks()) {
    const Eigen::Index row = state.offset(block);
    const WorldRole role = state.spec(block).role;
    if (role == WorldRole::kPose || role == WorldRole::kPoint)
      t.block<2, 1>(row, 2) = left_of(state.estimate(block).head<2>());
    if (role == WorldRole::kLine)
      t.block<1, 2>(row + 1, 0) = direction(state.estimate(block)[0]).transpose();
  }
  return t;
}

/// xi of a turn and a shift of the world, whatever the estimates are.
Eigen::VectorXd world_motion(const World& world, double turn, const Eigen::Vector2d& shift) {
  Eigen::VectorXd xi = Eigen::VectorXd::Zero(kDimension);
  xi[2] = turn;
  for (const BlockId block : world.state.blocks()) {
    const Eigen::Index row = world.state.offset(block);
    const WorldRole role = world.state.spec(block).role;
    if (role == WorldRole::kPose || role == WorldRole::kPoint) xi.segment<2>(row) = shift;
    if (role == WorldRole::kLine) xi[row] = turn;
  }
  return xi;
}

/// V(turn) of SE(2), by its power series.
Eigen::Matrix2d left_jacobian(double turn) {
  const Eigen::Matrix2d generator = (Eigen::Matrix2d() << 0, -turn, turn, 0).finished();
  Eigen::Matrix2d sum = Eigen::Matrix2d::Identity(), term = sum;
  for (int k = 2; k < 40; ++k) {
    term = term * generator / k;
    sum += term;
  }
  return sum;
}

}  // namespace

TEST(LineErrorFrame, AShiftAndATurnOfTheWorldAreRetractedExactly) {
  std::mt19937_64 random(81);
  for (const double turn : {0.0, 1e-8, -1e-3, 0.7, 3.1, -3.1}) {
    const World before = make_world(random);
    World after = before;
    const Eigen::Vector2d shift = random_matrix(2, 1, random, 5.0);
    const Eigen::VectorXd delta = chart_change(before) * world_motion(before, turn, shift);
    RightInvariantFrame frame;
    static_cast<void>(frame.retract(after.state, after.pose, delta));
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(turn).toRotationMatrix();
    const Eigen::Vector2d t = left_jacobian(turn) * shift;
    for (const BlockId block : before.state.blocks()) {
      const Eigen::VectorXd x = before.state.estimate(block), y = after.state.estimate(block);
      switch (before.state.spec(block).role) {
        case WorldRole::kNone:
          EXPECT_EQ(x, y);
          break;
        case WorldRole::kLine: {  // two points of the line before are on the line after
          const Eigen::Vector2d n = direction(x[0]), n_after = direction(y[0]);
          EXPECT_LT((n_after - R * n).norm(), 1e-12) << turn;
          for (const double along : {-7.0, 11.0}) {
            const Eigen::Vector2d p = R * (x[1] * n + along * left_of(n)) + t;
            EXPECT_NEAR(n_after.dot(p), y[1], 1e-12 * (1.0 + p.norm())) << turn;
          }
          break;
        }
        default:
          EXPECT_LT((y.head<2>() - (R * x.head<2>() + t)).norm(), 1e-12) << turn;
      }
    }
  }
}

TEST(LineErrorFrame, RetractionIsTheAdditiveOneToFirstOrder) {
  std::mt19937_64 random(82);
  const World before = make_world(random);
  const Eigen::VectorXd delta = 1e-6 * random_matrix(kDimension, 1, random);
  World after = before;
  RightInvariantFrame frame;
  static_cast<void>(frame.retract(after.state, after.pose, delta));
  for (const BlockId block : before.state.blocks()) {
    const Eigen::VectorXd moved = boxminus(before.state.spec(block), after.state.estimate(block),
                                           before.state.estimate(block));
    const Eigen::VectorXd wanted =
        delta.segment(before.state.offset(block), before.state.size(block));
    // Second order: |delta|^2 times the distance from the origin, about 20 m.
    EXPECT_LT((moved - wanted).norm(), 50.0 * delta.squaredNorm());
  }
}

TEST(LineErrorFrame, ChangeOfChartKeepsTheCovarianceOfTheInvariantError) {
  std::mt19937_64 random(83);
  World world = make_world(random);
  const Eigen::MatrixXd inverse = chart_change(world).inverse();
  const Eigen::MatrixXd p_xi = inverse * world.state.full_covariance() * inverse.transpose();
  RightInvariantFrame frame;
  world.state.covariance().correct(
      frame.retract(world.state, world.pose, random_matrix(kDimension, 1, random, 0.3)));
  const Eigen::MatrixXd t = chart_change(world);
  EXPECT_LT((world.state.full_covariance() - t * p_xi * t.transpose()).norm(),
            1e-11 * p_xi.norm() * t.squaredNorm());
  // The test can fail: the lines did move.
  const Eigen::MatrixXd still = inverse.inverse();
  EXPECT_GT((still * p_xi * still.transpose() - t * p_xi * t.transpose()).norm(), 1e-3);
}

// A line of a given map, say, or one that nothing is correlated with.
TEST(LineErrorFrame, ALineWithoutCorrectionStaysBitForBit) {
  std::mt19937_64 random(84);
  World world = make_world(random);
  const World before = world;
  Eigen::VectorXd delta = random_matrix(kDimension, 1, random);
  delta.tail(2 * kLines).setZero();
  RightInvariantFrame frame;
  const ChartChange change = frame.retract(world.state, world.pose, delta);
  for (const BlockId block : world.state.blocks())
    if (world.state.spec(block).role == WorldRole::kLine) {
      EXPECT_EQ(world.state.estimate(block), before.state.estimate(block));
    }
  EXPECT_TRUE(change.u.bottomRows(2 * kLines).isZero(0.0));
}

TEST(LineErrorFrame, IsForThePlaneAlone) {
  GaussianState state;
  Eigen::VectorXd start = Eigen::VectorXd::Zero(7);
  start[6] = 1.0;
  const BlockId pose =
      state.add({"pose", Chart::kSE3, 6, WorldRole::kPose}, start, Eigen::MatrixXd::Identity(6, 6));
  state.add({"", Chart::kLine, 2, WorldRole::kLine}, Eigen::Vector2d(1, 2),
            Eigen::Matrix2d::Identity());
  RightInvariantFrame frame;
  EXPECT_THROW(static_cast<void>(frame.retract(state, pose, Eigen::VectorXd::Ones(8))),
               std::invalid_argument);
}
