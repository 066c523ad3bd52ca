// body_twist and constant_twist: exactness, Jacobians by regime, noise.

#include <cmath>
#include <random>
#include <support/numeric_jacobian.hpp>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/motion/body_twist.hpp>
#include <libslam/motion/constant_twist.hpp>
#include <libslam/state/so3.hpp>

namespace libslam {
namespace {

using testing::numeric_jacobian;

struct SpatialMotion {
  SpatialMotion(const MotionModel& model, const BlockVector& start) {
    pose = state.add(model.pose_spec(), start, Eigen::MatrixXd::Identity(6, 6));
    double value = 0.02;
    for (const CalibrationSpec& spec : model.calibration())
      blocks.push_back(state.add({spec.name, Chart::kVector, 1, WorldRole::kNone},
                                 Eigen::VectorXd::Constant(1, spec.prior_mean + (value *= -1.3)),
                                 Eigen::MatrixXd::Identity(1, 1)));
  }
  MotionStep step(const MotionModel& model, const MotionAction& action) const {
    MotionStep result;
    model.linearize(state, pose, blocks, action, result);
    return result;
  }
  Eigen::VectorXd calibration() const {
    Eigen::VectorXd values(static_cast<Eigen::Index>(blocks.size()));
    for (std::size_t i = 0; i < blocks.size(); ++i)
      values[static_cast<Eigen::Index>(i)] = state.estimate(blocks[i])[0];
    return values;
  }

  GaussianState state;
  BlockId pose;
  CalibrationBlocks blocks;
};

BlockVector pose_of(const Eigen::Vector3d& position, const Eigen::Vector3d& theta) {
  BlockVector pose(7);
  pose << position, so3_exp(theta).coeffs();
  return pose;
}

std::vector<BlockVector> poses_by_regime() {
  return {pose_of({0, 0, 0}, {0, 0, 0}), pose_of({1, -2, 3}, {1e-8, 0, -1e-8}),
          pose_of({-3, 4, 0.5}, {0.4, -1.0, 2.0}), pose_of({5, 1, -2}, {0, M_PI - 1e-9, 0})};
}

std::vector<Twist> twists_by_regime() {
  std::vector<Twist> twists{Twist::Zero()};
  twists.push_back((Twist() << 1e-8, 0, 1e-8, 0, 1e-8, 0).finished());
  twists.push_back((Twist() << 2.0, -0.3, 0.1, 0.2, -0.1, 0.6).finished());
  twists.push_back((Twist() << -6.0, 0.2, 0.3, 2.9, 0.1, -0.2).finished());
  twists.push_back((Twist() << 1.0, 0.5, -0.5, 4.0, 4.0, -2.5).finished());  // a turn near pi
  return twists;
}

MotionAction action_of(const Twist& twist, double dt = 0.5) {
  MotionAction action;
  action.dt = dt;
  action.twist = twist;
  return action;
}

CalibrationParameters all_biases() {
  CalibrationParameters calibration;
  calibration.scale_speed.enabled = true;
  for (auto* bias : {&calibration.bias_gyro_x, &calibration.bias_gyro_y, &calibration.bias_gyro_z})
    bias->enabled = true;
  return calibration;
}

void expect_jacobians(const MotionModel& model, const BlockVector& pose,
                      const MotionAction& action) {
  const SpatialMotion at(model, pose);
  const MotionStep step = at.step(model, action);
  ASSERT_EQ(step.wrt.size(), static_cast<int>(1 + at.blocks.size()));
  const auto f = [&](const GaussianState& state) {
    MotionStep moved;
    model.linearize(state, at.pose, at.blocks, action, moved);
    return Eigen::VectorXd(moved.estimate);
  };
  for (const BlockJacobian& entry : step.wrt) {
    const Eigen::MatrixXd numeric = numeric_jacobian(at.state, entry.block, f, model.pose_spec());
    EXPECT_LT((entry.jacobian - numeric).cwiseAbs().maxCoeff(),
              1e-8 * (1.0 + numeric.cwiseAbs().maxCoeff()))
        << at.state.spec(entry.block).name << "\nanalytic\n"
        << entry.jacobian << "\nnumeric\n"
        << numeric;
  }
}

TEST(BodyTwist, FollowsTheExponentialOfTheTwist) {
  const BodyTwist model({}, {});
  for (const BlockVector& pose : poses_by_regime())
    for (const Twist& twist : twists_by_regime()) {
      const BlockVector moved = SpatialMotion(model, pose).step(model, action_of(twist)).estimate;
      Eigen::Matrix4d algebra = Eigen::Matrix4d::Zero(), T = Eigen::Matrix4d::Identity();
      algebra.topLeftCorner<3, 3>() = 0.5 * skew(twist.tail<3>());
      algebra.topRightCorner<3, 1>() = 0.5 * twist.head<3>();
      T.topLeftCorner<3, 3>() =
          Eigen::Quaterniond(pose[6], pose[3], pose[4], pose[5]).toRotationMatrix();
      T.topRightCorner<3, 1>() = pose.head<3>();
      const Eigen::Matrix4d expected = T * algebra.exp();
      const Eigen::Quaterniond q(moved[6], moved[3], moved[4], moved[5]);
      EXPECT_LT((moved.head<3>() - expected.topRightCorner<3, 1>()).norm(), 1e-12);
      EXPECT_LT((q.toRotationMatrix() - expected.topLeftCorner<3, 3>()).norm(), 1e-12);
    }
}

TEST(BodyTwist, Jacobians) {
  const BodyTwist model({}, all_biases());
  for (const BlockVector& pose : poses_by_regime())
    for (const Twist& twist : twists_by_regime()) expect_jacobians(model, pose, action_of(twist));
}

TEST(ConstantTwist, Jacobians) {
  const ConstantTwist model({});
  ASSERT_EQ(model.calibration().size(), 6U);
  MotionAction action;
  for (const BlockVector& pose : poses_by_regime())
    for (const double dt : {0.0, 1e-8, 0.3}) {
      action.dt = dt;
      expect_jacobians(model, pose, action);
    }
}

TEST(ConstantTwist, MovesByItsVelocityStates) {
  const ConstantTwist model({});
  const SpatialMotion at(model, pose_of({0, 0, 0}, {0, 0, 0}));
  MotionAction action;
  action.dt = 2.0;
  const Twist expected = 2.0 * at.calibration();
  const BlockVector moved = at.step(model, action).estimate;
  EXPECT_LT((so3_log({moved[6], moved[3], moved[4], moved[5]}) - expected.tail<3>()).norm(), 1e-12);
  EXPECT_LT((moved.head<3>() - so3_left_jacobian(expected.tail<3>()) * expected.head<3>()).norm(),
            1e-12);
}

TEST(BodyTwist, CalibrationActsAsDocumented) {
  CalibrationParameters constants;
  constants.scale_speed.prior_mean = 1.25;
  constants.bias_gyro_z.prior_mean = 0.1;
  const Twist read = (Twist() << 0.8, 0, 0, 0, 0, 0.5).finished();
  const Twist real = (Twist() << 1.0, 0, 0, 0, 0, 0.4).finished();
  const BlockVector start = poses_by_regime()[2];
  const BodyTwist corrected({}, constants), plain({}, {});
  const BlockVector a = SpatialMotion(corrected, start).step(corrected, action_of(read)).estimate;
  const BlockVector b = SpatialMotion(plain, start).step(plain, action_of(real)).estimate;
  EXPECT_LT((a - b).norm(), 1e-13);
  const BodyTwist calibrated({}, all_biases());
  for (const CalibrationSpec& spec : calibrated.calibration())
    EXPECT_EQ(spec.additive, spec.name.starts_with("bias")) << spec.name;
}

// The parts of a reading that holds for T seconds add up to (sigma T)^2 however it is cut; a
// density adds up to density^2 T.
TEST(BodyTwist, NoiseDoesNotDependOnHowAReadingIsCut) {
  TwistParameters noise;
  noise.speed_per_sqrt_s = 0.05;
  const BodyTwist model(noise, {});
  MotionAction whole = action_of(Twist::Zero(), 0.4), part = action_of(Twist::Zero(), 0.1);
  part.hold = 0.4;
  const BlockVector start = pose_of({0, 0, 0}, {0, 0, 0});
  const BlockMatrix at_once = SpatialMotion(model, start).step(model, whole).cov_noise;
  const BlockMatrix quarter = SpatialMotion(model, start).step(model, part).cov_noise;
  EXPECT_LT((4.0 * quarter - at_once).norm(), 1e-15);
  EXPECT_NEAR(at_once(0, 0), std::pow(0.1 * 0.4, 2) + 0.05 * 0.05 * 0.4, 1e-15);
  EXPECT_NEAR(at_once(5, 5), std::pow(0.01 * 0.4, 2), 1e-15);
}

// With n samples a mean scatters by sigma / sqrt(n) and a covariance entry by at most sqrt(2 / n)
// sigma_i sigma_j; five of these are allowed.
TEST(BodyTwist, SamplesHaveTheLinearizedMoments) {
  constexpr int kSamples = 20000;
  TwistParameters noise;
  noise.sigma_speed_x = 0.02;
  noise.sigma_rate_y = 0.004;
  const BodyTwist model(noise, all_biases());
  const BlockVector start = poses_by_regime()[2];
  const SpatialMotion at(model, start);
  const MotionAction action = action_of(twists_by_regime()[2]);
  const MotionStep step = at.step(model, action);
  std::mt19937_64 random(7);
  Eigen::MatrixXd errors(kSamples, 6);
  for (int i = 0; i < kSamples; ++i)
    errors.row(i) = boxminus(model.pose_spec(),
                             model.sample(start, at.calibration(), action, random), step.estimate)
                        .transpose();
  const Eigen::RowVectorXd mean = errors.colwise().mean();
  errors.rowwise() -= mean;
  const Eigen::MatrixXd cov = errors.transpose() * errors / (kSamples - 1);
  const Eigen::VectorXd sigma = step.cov_noise.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < 6; ++i) {
    // Second-order terms of a turn: its variance times the speed.
    EXPECT_LE(std::abs(mean[i]), 5.0 * sigma[i] / std::sqrt(kSamples) + 2e-5) << i;
    for (Eigen::Index j = 0; j < 6; ++j)
      EXPECT_LE(std::abs(cov(i, j) - step.cov_noise(i, j)),
                5.0 * std::sqrt(2.0 / kSamples) * sigma[i] * sigma[j] + 1e-12)
          << i << ' ' << j;
  }
}

TEST(BodyTwist, RefusesWhatItCannotUse) {
  const BodyTwist model({}, {});
  const SpatialMotion at(model, poses_by_regime()[0]);
  MotionStep step;
  EXPECT_THROW(model.linearize(at.state, at.pose, {}, MotionAction{}, step), std::invalid_argument);
  std::mt19937_64 random(1);
  EXPECT_THROW(static_cast<void>(model.sample(poses_by_regime()[0], Eigen::VectorXd::Ones(2),
                                              action_of(Twist::Zero()), random)),
               std::invalid_argument);
}

}  // namespace
}  // namespace libslam
