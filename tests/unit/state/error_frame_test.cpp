#include <random>
#include <tests/support/random_matrix.hpp>
#include <unsupported/Eigen/MatrixFunctions>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/state/error_frame.hpp>

using namespace libslam;
using libslam::testing::random_covariance;
using libslam::testing::random_matrix;

namespace {

constexpr int kPoints = 3;
constexpr Eigen::Index kDimension = 3 + 1 + 2 * kPoints;

struct World {
  GaussianState state;
  BlockId pose;
};

/// Pose, one calibration number, three points; fully correlated.
World make_world(std::mt19937_64& random) {
  World world;
  world.pose = world.state.add({"pose", Chart::kSE2, 3, WorldRole::kPose},
                               random_matrix(3, 1, random, 2.0), random_covariance(3, random));
  Initialization block;
  block.estimate = random_matrix(1, 1, random);
  block.wrt.add(world.pose, 1, 3) = random_matrix(1, 3, random);
  block.cov_noise = random_covariance(1, random);
  world.state.augment({"scale", Chart::kVector, 1, WorldRole::kNone}, block);
  for (int i = 0; i < kPoints; ++i) {
    block.wrt.clear();
    block.estimate = random_matrix(2, 1, random, 10.0);
    block.wrt.add(world.pose, 2, 3) = random_matrix(2, 3, random);
    block.cov_noise = random_covariance(2, random);
    world.state.augment({"point", Chart::kVector, 2, WorldRole::kPoint}, block);
  }
  return world;
}

Eigen::Matrix2d quarter_turn() {
  return (Eigen::Matrix2d() << 0, -1, 1, 0).finished();
}

/// delta = T(x) xi, written out from the definition in the header.
Eigen::MatrixXd chart_change(const GaussianState& state) {
  Eigen::MatrixXd t = Eigen::MatrixXd::Identity(kDimension, kDimension);
  for (const BlockId block : state.blocks())
    if (state.spec(block).role != WorldRole::kNone)
      t.block<2, 1>(state.offset(block), 2) = quarter_turn() * state.estimate(block).head<2>();
  return t;
}

}  // namespace

TEST(ErrorFrame, RightInvariantRetractionIsTheGroupExponential) {
  std::mt19937_64 random(31);
  for (const double turn : {0.0, 1e-8, -1e-3, 0.7, 3.1}) {
    World world = make_world(random);
    Eigen::VectorXd delta = random_matrix(kDimension, 1, random);
    delta[2] = turn;
    const Eigen::VectorXd xi = chart_change(world.state).inverse() * delta;
    // SE_{1+n}(2): the matrix [R p m_1 .. m_n] and the exponential of its algebra.
    const Eigen::Index size = 2 + 1 + kPoints;
    Eigen::MatrixXd algebra = Eigen::MatrixXd::Zero(size, size),
                    element = Eigen::MatrixXd::Identity(size, size);
    algebra.topLeftCorner<2, 2>() = turn * quarter_turn();
    element.topLeftCorner<2, 2>() =
        Eigen::Rotation2Dd(world.state.estimate(world.pose)[2]).toRotationMatrix();
    Eigen::Index column = 2;
    for (const BlockId block : world.state.blocks()) {
      if (world.state.spec(block).role == WorldRole::kNone) continue;
      algebra.block<2, 1>(0, column) = xi.segment<2>(world.state.offset(block));
      element.block<2, 1>(0, column++) = world.state.estimate(block).head<2>();
    }
    const Eigen::MatrixXd expected = algebra.exp() * element;
    RightInvariantFrame frame;
    static_cast<void>(frame.retract(world.state, world.pose, delta));
    column = 2;
    for (const BlockId block : world.state.blocks()) {
      if (world.state.spec(block).role == WorldRole::kNone) continue;
      EXPECT_LT((world.state.estimate(block).head<2>() - expected.block<2, 1>(0, column++)).norm(),
                1e-12)
          << "turn " << turn;
    }
    const double heading = std::atan2(expected(1, 0), expected(0, 0));
    EXPECT_NEAR(wrap_angle(world.state.estimate(world.pose)[2] - heading), 0.0, 1e-12);
  }
}

TEST(ErrorFrame, ChangeOfChartKeepsTheCovarianceOfTheInvariantError) {
  std::mt19937_64 random(32);
  World world = make_world(random);
  const Eigen::MatrixXd before_inverse = chart_change(world.state).inverse();
  const Eigen::MatrixXd p_xi =
      before_inverse * world.state.full_covariance() * before_inverse.transpose();
  RightInvariantFrame frame;
  world.state.covariance().correct(
      frame.retract(world.state, world.pose, random_matrix(kDimension, 1, random, 0.3)));
  const Eigen::MatrixXd after = chart_change(world.state);
  EXPECT_LT((world.state.full_covariance() - after * p_xi * after.transpose()).norm(),
            1e-11 * p_xi.norm() * after.squaredNorm());
}

// A turn of the world is one direction of the invariant error, whatever the estimates: a delayed
// pose moves along with the robot and keeps its own heading error.
TEST(ErrorFrame, RightInvariantDelayedPoseTurnsWithTheWorld) {
  std::mt19937_64 random(35);
  World world = make_world(random);
  const BlockId delayed = world.state.add({"before", Chart::kSE2, 3, WorldRole::kPose},
                                          Eigen::Vector3d(2.0, -1.0, 3.0), Eigen::Matrix3d::Zero());
  constexpr double kTurn = 0.4;
  Eigen::VectorXd delta = Eigen::VectorXd::Zero(kDimension + 3);
  for (const BlockId block : world.state.blocks()) {
    if (world.state.spec(block).role == WorldRole::kNone) continue;
    delta.segment<2>(world.state.offset(block)) =
        kTurn * quarter_turn() * world.state.estimate(block).head<2>();
    if (world.state.spec(block).role == WorldRole::kPose)
      delta[world.state.offset(block) + 2] = kTurn;
  }
  const Eigen::Vector2d turned =
      Eigen::Rotation2Dd(kTurn) * Eigen::Vector2d(world.state.estimate(delayed).head<2>());
  RightInvariantFrame frame;
  static_cast<void>(frame.retract(world.state, world.pose, delta));
  const Eigen::Vector3d moved = world.state.estimate(delayed);
  EXPECT_LT((moved.head<2>() - turned).norm(), 1e-12);
  EXPECT_NEAR(moved[2], wrap_angle(3.0 + kTurn), 1e-12);
}

// Localization in a given map: the group turns about the origin and back, which rounds.
TEST(ErrorFrame, APointWithoutCorrectionStaysBitForBit) {
  std::mt19937_64 random(37);
  RightInvariantFrame frame;
  for (const Chart chart : {Chart::kSE2, Chart::kSE3})
    for (int trial = 0; trial < 50; ++trial) {
      const int dimension = chart == Chart::kSE2 ? 2 : 3, error = 3 * (dimension - 1);
      BlockVector start = BlockVector::Zero(chart == Chart::kSE2 ? 3 : 7);
      if (chart == Chart::kSE3) start[6] = 1.0;
      GaussianState state;
      const BlockId pose = state.add({"pose", chart, 3, WorldRole::kPose}, start,
                                     Eigen::MatrixXd::Identity(error, error));
      const Eigen::VectorXd place = 100.0 * random_matrix(dimension, 1, random);
      const BlockId point = state.add({"", Chart::kVector, dimension, WorldRole::kPoint}, place,
                                      Eigen::MatrixXd::Identity(dimension, dimension));
      Eigen::VectorXd delta = random_matrix(error + dimension, 1, random);
      delta.tail(dimension).setZero();
      const ChartChange change = frame.retract(state, pose, delta);
      EXPECT_EQ(Eigen::VectorXd(state.estimate(point)), place);
      EXPECT_TRUE(change.u.bottomRows(dimension).isZero(0.0));
      EXPECT_NE(Eigen::VectorXd(state.estimate(pose)), Eigen::VectorXd(start));
    }
}

TEST(ErrorFrame, StandardAddsAndKeepsTheCovariance) {
  std::mt19937_64 random(33);
  World world = make_world(random);
  const Eigen::MatrixXd p = world.state.full_covariance();
  const Eigen::Vector3d before = world.state.estimate(world.pose);
  const Eigen::VectorXd delta = random_matrix(kDimension, 1, random);
  EXPECT_EQ(StandardFrame().retract(world.state, world.pose, delta).u.cols(), 0);
  EXPECT_EQ(world.state.full_covariance(), p);
  const Eigen::Vector3d moved = world.state.estimate(world.pose);
  EXPECT_LT((moved.head<2>() - before.head<2>() - delta.head<2>()).norm(), 1e-15);
  EXPECT_NEAR(moved[2], wrap_angle(before[2] + delta[2]), 1e-15);
}

TEST(ErrorFrame, RefusesWhatItIsNotDerivedFor) {
  const RightInvariantFrame frame;
  EXPECT_THROW(frame.require_supported({"line", Chart::kAngle, 1, WorldRole::kPoint}),
               std::invalid_argument);
  EXPECT_THROW(frame.require_supported({"plane", Chart::kVector, 4, WorldRole::kPoint}),
               std::invalid_argument);
  EXPECT_NO_THROW(frame.require_supported({"gain", Chart::kVector, 4, WorldRole::kNone}));
  std::mt19937_64 random(34);
  World world = make_world(random);
  EXPECT_THROW(static_cast<void>(
                   RightInvariantFrame().retract(world.state, world.pose, Eigen::Vector3d::Zero())),
               std::invalid_argument);
  EXPECT_THROW(make_error_frame("left"), std::invalid_argument);
}
