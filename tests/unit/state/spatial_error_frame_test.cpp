// The right-invariant error of SE_{1+n}(3), and of a planar pose among points in space.

#include <random>
#include <tests/support/random_matrix.hpp>
#include <unsupported/Eigen/MatrixFunctions>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/state/error_frame.hpp>
#include <libslam/state/so3.hpp>

using namespace libslam;
using libslam::testing::random_covariance;
using libslam::testing::random_matrix;

namespace {

constexpr int kPoints = 3;
constexpr Eigen::Index kDimension = 6 + 1 + 3 * kPoints;

struct World {
  GaussianState state;
  BlockId pose;
};

void add_points(World& world, std::mt19937_64& random) {
  Initialization block;
  for (int i = 0; i < kPoints; ++i) {
    block.wrt.clear();
    block.estimate = random_matrix(3, 1, random, 10.0);
    block.wrt.add(world.pose, 3, world.state.size(world.pose)) =
        random_matrix(3, world.state.size(world.pose), random);
    block.cov_noise = random_covariance(3, random);
    world.state.augment({"point", Chart::kVector, 3, WorldRole::kPoint}, block);
  }
}

/// Pose, one calibration number, three points; fully correlated.
World make_world(std::mt19937_64& random) {
  World world;
  Eigen::VectorXd pose(7);
  pose << random_matrix(3, 1, random, 2.0),
      so3_exp(Eigen::Vector3d(random_matrix(3, 1, random))).coeffs();
  world.pose = world.state.add({"pose", Chart::kSE3, 6, WorldRole::kPose}, pose,
                               random_covariance(6, random));
  world.state.add({"bias", Chart::kVector, 1, WorldRole::kNone}, random_matrix(1, 1, random),
                  random_covariance(1, random));
  add_points(world, random);
  return world;
}

/// delta = T(x) xi, written out from the definition in the header.
Eigen::MatrixXd chart_change(const World& world) {
  const GaussianState& state = world.state;
  Eigen::MatrixXd t = Eigen::MatrixXd::Identity(state.dimension(), state.dimension());
  for (const BlockId block : state.blocks())
    if (state.spec(block).role != WorldRole::kNone)
      t.block<3, 3>(state.offset(block), state.offset(world.pose) + 3) =
          -skew(state.estimate(block).head<3>());
  return t;
}

Eigen::Quaterniond rotation_of(const World& world) {
  const auto x = world.state.estimate(world.pose);
  return {x[6], x[3], x[4], x[5]};
}

/// The matrix [R p m_1 .. m_n].
Eigen::MatrixXd element_of(const World& world) {
  const Eigen::Index size = 3 + 1 + kPoints;
  Eigen::MatrixXd element = Eigen::MatrixXd::Identity(size, size);
  element.topLeftCorner<3, 3>() = rotation_of(world).toRotationMatrix();
  Eigen::Index column = 3;
  for (const BlockId block : world.state.blocks())
    if (world.state.spec(block).role != WorldRole::kNone)
      element.block<3, 1>(0, column++) = world.state.estimate(block).head<3>();
  return element;
}

}  // namespace

TEST(SpatialErrorFrame, RetractionIsTheGroupExponential) {
  std::mt19937_64 random(41);
  for (const double turn : {0.0, 1e-8, 1e-3, 0.7, 3.1}) {
    World world = make_world(random);
    Eigen::VectorXd delta = random_matrix(kDimension, 1, random);
    delta.segment<3>(3) *= turn / delta.segment<3>(3).norm();
    const Eigen::VectorXd xi = chart_change(world).inverse() * delta;
    Eigen::MatrixXd algebra = Eigen::MatrixXd::Zero(3 + 1 + kPoints, 3 + 1 + kPoints);
    algebra.topLeftCorner<3, 3>() = skew(xi.segment<3>(3));
    Eigen::Index column = 3;
    for (const BlockId block : world.state.blocks())
      if (world.state.spec(block).role != WorldRole::kNone)
        algebra.block<3, 1>(0, column++) = xi.segment<3>(world.state.offset(block));
    const Eigen::MatrixXd expected = algebra.exp() * element_of(world);
    RightInvariantFrame frame;
    static_cast<void>(frame.retract(world.state, world.pose, delta));
    EXPECT_LT((element_of(world) - expected).norm(), 1e-12 * expected.norm()) << "turn " << turn;
  }
}

TEST(SpatialErrorFrame, ChangeOfChartKeepsTheCovarianceOfTheInvariantError) {
  std::mt19937_64 random(42);
  World world = make_world(random);
  const Eigen::MatrixXd before_inverse = chart_change(world).inverse();
  const Eigen::MatrixXd p_xi =
      before_inverse * world.state.full_covariance() * before_inverse.transpose();
  RightInvariantFrame frame;
  world.state.covariance().correct(
      frame.retract(world.state, world.pose, random_matrix(kDimension, 1, random, 0.3)));
  const Eigen::MatrixXd after = chart_change(world);
  EXPECT_LT((world.state.full_covariance() - after * p_xi * after.transpose()).norm(),
            1e-11 * p_xi.norm() * after.squaredNorm());
}

// A point whose correction is zero is known: it stays where it is however the robot turns.
TEST(SpatialErrorFrame, PointWithoutCorrectionStays) {
  std::mt19937_64 random(43);
  World world = make_world(random);
  const BlockId known = world.state.blocks().back();
  const Eigen::Vector3d before = world.state.estimate(known);
  Eigen::VectorXd delta = random_matrix(kDimension, 1, random);
  delta.segment<3>(world.state.offset(known)).setZero();
  RightInvariantFrame frame;
  static_cast<void>(frame.retract(world.state, world.pose, delta));
  EXPECT_EQ(Eigen::Vector3d(world.state.estimate(known)), before);
}

// A delayed pose turns with the world, in place and in orientation.
TEST(SpatialErrorFrame, DelayedPoseTurnsWithTheWorld) {
  std::mt19937_64 random(44);
  World world = make_world(random);
  Eigen::VectorXd start(7);
  start << 2.0, -1.0, 3.0, so3_exp({0.2, 0.5, -1.0}).coeffs();
  const BlockId delayed = world.state.add({"before", Chart::kSE3, 6, WorldRole::kPose}, start,
                                          Eigen::MatrixXd::Zero(6, 6));
  const Eigen::Vector3d turn(0.3, -0.2, 0.4);
  Eigen::VectorXd delta = Eigen::VectorXd::Zero(kDimension + 6);
  for (const BlockId block : world.state.blocks()) {
    if (world.state.spec(block).role == WorldRole::kNone) continue;
    const Eigen::Vector3d at = world.state.estimate(block).head<3>();
    delta.segment<3>(world.state.offset(block)) = turn.cross(at);
    if (world.state.spec(block).role == WorldRole::kPose)
      delta.segment<3>(world.state.offset(block) + 3) = turn;
  }
  RightInvariantFrame frame;
  static_cast<void>(frame.retract(world.state, world.pose, delta));
  const auto x = world.state.estimate(delayed);
  EXPECT_LT((x.head<3>() - so3_exp(turn) * Eigen::Vector3d(start.head<3>())).norm(), 1e-12);
  const Eigen::Quaterniond expected = so3_exp(turn) * Eigen::Quaterniond(start.tail<4>());
  EXPECT_LT(Eigen::Quaterniond(x.tail<4>()).angularDistance(expected), 1e-7);
}

// A planar robot among points in space: positions turn about the vertical, heights are their own.
TEST(SpatialErrorFrame, PlanarPoseTurnsPointsAboutTheVertical) {
  std::mt19937_64 random(45);
  World world;
  world.pose = world.state.add({"pose", Chart::kSE2, 3, WorldRole::kPose},
                               random_matrix(3, 1, random, 2.0), random_covariance(3, random));
  add_points(world, random);
  const BlockId point = world.state.blocks().back();
  const Eigen::Vector3d before = world.state.estimate(point);
  constexpr double kTurn = 0.4, kLift = 0.7;
  Eigen::VectorXd delta = Eigen::VectorXd::Zero(world.state.dimension());
  for (const BlockId block : world.state.blocks()) {
    const auto x = world.state.estimate(block);
    delta.segment<2>(world.state.offset(block)) = kTurn * Eigen::Vector2d(-x[1], x[0]);
  }
  delta[2] = kTurn;
  delta[world.state.offset(point) + 2] = kLift;
  RightInvariantFrame frame;
  const ChartChange change = frame.retract(world.state, world.pose, delta);
  Eigen::Vector3d expected = Eigen::AngleAxisd(kTurn, Eigen::Vector3d::UnitZ()) * before;
  expected.z() += kLift;
  EXPECT_LT((world.state.estimate(point) - expected).norm(), 1e-12);
  EXPECT_EQ(change.u(world.state.offset(point) + 2, 0), 0.0);
}

TEST(SpatialErrorFrame, RefusesPlanarPointsOfARobotInSpace) {
  std::mt19937_64 random(46);
  World world = make_world(random);
  world.state.add({"flat", Chart::kVector, 2, WorldRole::kPoint}, Eigen::Vector2d::Zero(),
                  Eigen::Matrix2d::Identity());
  RightInvariantFrame frame;
  EXPECT_THROW(static_cast<void>(
                   frame.retract(world.state, world.pose, Eigen::VectorXd::Ones(kDimension + 2))),
               std::invalid_argument);
}
