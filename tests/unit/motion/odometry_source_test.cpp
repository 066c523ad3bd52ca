#include <stdexcept>

#include <gtest/gtest.h>

#include <libslam/motion/odometry_source.hpp>

namespace libslam {
namespace {

TEST(OdometrySource, NamesOfTheConfiguration) {
  InputParameters input;
  EXPECT_EQ(odometry_source(input), OdometrySource::kIncrements);  // auto
  input.odometry = "increments";
  EXPECT_EQ(odometry_source(input), OdometrySource::kIncrements);
  input.odometry = "velocities";
  EXPECT_EQ(odometry_source(input), OdometrySource::kVelocities);
  input.odometry = "ticks";
  EXPECT_EQ(odometry_source(input), OdometrySource::kTicks);
  input.odometry = "wheel";
  EXPECT_THROW(odometry_source(input), std::invalid_argument);
}

TEST(OdometrySource, VelocityNeedsAnInterval) {
  MotionAction action;
  action.increment = {0.3, 0.0, 0.0};
  action.velocity = Eigen::Vector2d(2.0, 0.5);
  EXPECT_EQ(movement_of(action, OdometrySource::kVelocities), Eigen::Vector3d(0.3, 0.0, 0.0));
  action.dt = 0.1;
  EXPECT_EQ(movement_of(action, OdometrySource::kVelocities), Eigen::Vector3d(0.2, 0.0, 0.05));
}

TEST(OdometrySource, AbsentFieldsThrow) {
  MotionAction action;
  action.dt = 0.1;
  EXPECT_THROW(movement_of(action, OdometrySource::kVelocities), std::invalid_argument);
  EXPECT_THROW(ticks_of(action), std::invalid_argument);
}

}  // namespace
}  // namespace libslam
