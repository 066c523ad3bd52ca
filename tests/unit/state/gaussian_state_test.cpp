#include <random>
#include <tests/support/random_matrix.hpp>

#include <gtest/gtest.h>

#include <libslam/state/gaussian_state.hpp>

using namespace libslam;
using libslam::testing::random_covariance;
using libslam::testing::random_matrix;

namespace {

const BlockSpec kPose{"pose", Chart::kSE2, 3, WorldRole::kPose};
const BlockSpec kPoint{"", Chart::kVector, 2, WorldRole::kPoint};

GaussianState state_with_points(int points, std::mt19937_64& random) {
  GaussianState state;
  const BlockId pose = state.add(kPose, random_matrix(3, 1, random), random_covariance(3, random));
  for (int i = 0; i < points; ++i) {
    Initialization point;
    point.estimate = random_matrix(2, 1, random);
    point.wrt.add(pose, 2, 3) = random_matrix(2, 3, random);
    point.cov_noise = random_covariance(2, random);
    BlockSpec spec = kPoint;
    spec.name = "point" + std::to_string(i);
    state.augment(spec, point);
  }
  return state;
}

}  // namespace

TEST(GaussianState, AugmentGivesTheCovarianceOfALinearFunction) {
  std::mt19937_64 random(21);
  GaussianState state;
  const Eigen::MatrixXd p = random_covariance(3, random);
  const BlockId pose = state.add(kPose, Eigen::Vector3d(1, 2, 3), p);
  Initialization point;
  point.estimate = Eigen::Vector2d(4, 5);
  const Eigen::MatrixXd g = random_matrix(2, 3, random);
  point.wrt.add(pose, 2, 3) = g;
  point.cov_noise = random_covariance(2, random);
  const BlockId landmark = state.augment(kPoint, point);
  EXPECT_LT((state.cross_covariance(landmark, pose) - g * p).norm(), 1e-13);
  EXPECT_LT((state.covariance_of(landmark) - (g * p * g.transpose() + point.cov_noise)).norm(),
            1e-13);
  EXPECT_EQ(state.estimate(landmark), Eigen::Vector2d(4, 5));
}

TEST(GaussianState, RemovingKeepsTheOtherBlocksAndTheirHandles) {
  std::mt19937_64 random(22);
  GaussianState state = state_with_points(4, random);
  const BlockId second = *state.find("point1"), last = *state.find("point3");
  const Eigen::VectorXd estimate = state.estimate(last);
  const Eigen::MatrixXd cov = state.covariance_of(last);
  state.remove(second);
  EXPECT_FALSE(state.alive(second));
  EXPECT_FALSE(state.find("point1").has_value());
  EXPECT_EQ(state.dimension(), 9);
  EXPECT_EQ(state.offset(last), 7);
  EXPECT_EQ(state.estimate(last), estimate);
  EXPECT_EQ(state.covariance_of(last), cov);
  EXPECT_THROW(state.estimate(second), std::out_of_range);
}

TEST(GaussianState, ACopyIsIndependent) {
  std::mt19937_64 random(23);
  GaussianState state = state_with_points(2, random);
  const GaussianState copy = state;
  const Eigen::MatrixXd before = copy.full_covariance();
  const BlockId pose = *state.find("pose");
  state.covariance().add_noise(0, BlockMatrix::Identity(3, 3));
  state.set_estimate(pose, Eigen::Vector3d::Zero());
  EXPECT_EQ(copy.full_covariance(), before);
  EXPECT_NE(copy.estimate(pose), state.estimate(pose));
}

TEST(GaussianState, WrongShapesNameTheBlock) {
  GaussianState state;
  try {
    state.add(kPose, Eigen::Vector2d::Zero(), Eigen::Matrix3d::Identity());
    FAIL() << "a pose of length 2 must be refused";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("'pose'"), std::string::npos) << e.what();
  }
  EXPECT_EQ(state.dimension(), 0);
  EXPECT_THROW(state.add(kPose, Eigen::Vector3d::Zero(), Eigen::Matrix2d::Identity()),
               std::invalid_argument);
  EXPECT_EQ(state.covariance().dimension(), 0);
}

TEST(GaussianState, AConstantHasAnEstimateAndNoError) {
  std::mt19937_64 random(24);
  GaussianState state = state_with_points(2, random);
  const BlockId constant = state.add_constant(kPoint, Eigen::Vector2d(7, 8));
  EXPECT_EQ(state.dimension(), 7);
  EXPECT_EQ(state.blocks().size(), 3u);
  EXPECT_TRUE(state.is_constant(constant));
  EXPECT_EQ(state.size(constant), 0);
  EXPECT_EQ(state.covariance_of(constant), BlockMatrix::Zero(2, 2));
  EXPECT_EQ(state.cross_covariance(state.blocks()[0], constant), BlockMatrix::Zero(3, 2));
  EXPECT_THROW(state.set_estimate(constant, Eigen::Vector2d(0, 0)), std::invalid_argument);
  state.remove(state.blocks()[1]);
  const GaussianState copy = state;
  EXPECT_EQ(copy.estimate(constant), Eigen::VectorXd(Eigen::Vector2d(7, 8)));
  state.remove(constant);
  EXPECT_FALSE(state.alive(constant));
  EXPECT_EQ(state.dimension(), 5);
}
