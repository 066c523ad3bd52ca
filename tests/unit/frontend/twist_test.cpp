// Body velocities of a log as odometry in space.

#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <mrpt/obs/CActionRobotMovement3D.h>

#include <libslam/frontend/odometry.hpp>

using namespace libslam;
using mrpt::obs::CActionRobotMovement3D;

namespace {

InputParameters twist_input() {
  InputParameters input;
  input.odometry = "twist";
  return input;
}

LogStep step_with(const CActionRobotMovement3D& motion) {
  LogStep step;
  step.dt = 0.25;
  step.action = mrpt::obs::CActionCollection::Create();
  step.action->insert(motion);
  return step;
}

CActionRobotMovement3D velocities(float wx = 0.4F) {
  CActionRobotMovement3D motion;
  motion.hasVelocities.assign(6, true);
  const std::array<float, 6> v = {1.0F, 2.0F, 3.0F, 0.6F, 0.5F, wx};  // x y z yaw pitch roll
  for (int i = 0; i < 6; ++i) motion.velocities[i] = v[static_cast<std::size_t>(i)];
  return motion;
}

}  // namespace

TEST(TwistOdometry, TakesTheVelocitiesOfAMovementInSpace) {
  OdometryReader reader(twist_input());
  const auto action = reader.read(step_with(velocities()));
  ASSERT_TRUE(action && action->twist);
  Eigen::Matrix<double, 6, 1> expected;
  expected << 1.0, 2.0, 3.0, 0.4, 0.5, 0.6;
  EXPECT_LT((*action->twist - expected).norm(), 1e-6);  // single precision of the class
  EXPECT_EQ(action->dt, 0.25);
  EXPECT_EQ(action->hold, 0.0);
}

TEST(TwistOdometry, TakesAHeldReadingFirst) {
  OdometryReader reader(twist_input());
  LogStep step;
  step.dt = 0.1;
  step.twist = HeldTwist{Eigen::Matrix<double, 6, 1>::Constant(0.5), 0.3};
  const auto action = reader.read(step);
  ASSERT_TRUE(action && action->twist);
  EXPECT_EQ((*action->twist)[3], 0.5);
  EXPECT_EQ(action->hold, 0.3);
  EXPECT_FALSE(reader.read(LogStep{}));
}

TEST(TwistOdometry, RefusesMovementsWithoutAllVelocities) {
  OdometryReader reader(twist_input());
  CActionRobotMovement3D motion = velocities();
  motion.hasVelocities[4] = false;
  EXPECT_THROW(reader.read(step_with(motion)), std::invalid_argument);
  motion = velocities();
  motion.hasVelocities.resize(5);  // a corrupt log
  EXPECT_THROW(reader.read(step_with(motion)), std::invalid_argument);
}

TEST(TwistOdometry, LeavesOutImpossibleVelocities) {
  OdometryReader reader(twist_input());
  EXPECT_THROW(reader.read(step_with(velocities(101.0F))), UnusableOdometry);
  EXPECT_THROW(reader.read(step_with(velocities(std::nanf("")))), UnusableOdometry);
}
