// Velocities of an IMU that drive an observation-only log.

#include <array>
#include <support/temporary_directory.hpp>

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationIMU.h>

#include <libslam/io/body_velocity.hpp>
#include <libslam/io/input_error.hpp>

#include "log_builder.hpp"

namespace libslam::test {
namespace {

constexpr std::array kFields = {mrpt::obs::IMU_X_VEL, mrpt::obs::IMU_Y_VEL, mrpt::obs::IMU_Z_VEL,
                                mrpt::obs::IMU_WX,    mrpt::obs::IMU_WY,    mrpt::obs::IMU_WZ};

mrpt::obs::CObservationIMU imu(double time, double forward, double turn) {
  mrpt::obs::CObservationIMU o;
  o.timestamp = stamp(time);
  o.sensorLabel = "imu";
  for (const auto field : kFields) o.set(field, 0.0);
  o.set(mrpt::obs::IMU_X_VEL, forward);
  o.set(mrpt::obs::IMU_WZ, turn);
  return o;
}

PlayerOptions twist_options(const std::string& policy = "strict") {
  PlayerOptions options = with_policy(policy);
  options.input.odometry = "twist";
  return options;
}

TEST(VelocityInRawlog, AReadingHoldsUntilTheNext) {
  const TemporaryDirectory directory;
  const std::string file =
      write_log(directory.path() / "x.rawlog", true, imu(1.0, 1.0, 0.5), sighting(1.25),
                imu(2.0, 2.0, 0.0), imu(2.5, 3.0, 0.0), sighting(2.5));
  RawlogPlayer player(file, twist_options());
  const std::vector<LogStep> steps = play(player);
  ASSERT_EQ(steps.size(), 3U);
  const std::array<double, 3> speed = {1.0, 1.0, 2.0}, dt = {0.25, 0.75, 0.5},
                              hold = {1.0, 1.0, 0.5};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    ASSERT_TRUE(steps[i].twist) << i;
    EXPECT_FALSE(steps[i].action) << i;
    EXPECT_EQ(steps[i].twist->twist[0], speed[i]);
    EXPECT_NEAR(steps[i].dt, dt[i], 1e-6);
    EXPECT_NEAR(steps[i].twist->hold, hold[i], 1e-6);
  }
  EXPECT_TRUE(steps[0].frame && !steps[1].frame && steps[2].frame);
  EXPECT_EQ(player.summary().actions, 3);
}

TEST(VelocityInRawlog, IsAnObservationLikeOthersWhereOdometryDrives) {
  const TemporaryDirectory directory;
  const std::string file =
      write_log(directory.path() / "x.rawlog", true, odometry(1.0, 0.0, 0.0, 0.0),
                imu(1.5, 1.0, 0.0), odometry(2.0, 1.0, 0.0, 0.0));
  RawlogPlayer player(file, with_policy("strict"));
  for (const LogStep& step : play(player)) EXPECT_FALSE(step.twist);
}

TEST(VelocityInRawlog, WithoutItsFieldsIsLeftOut) {
  const TemporaryDirectory directory;
  mrpt::obs::CObservationIMU blank;
  blank.timestamp = stamp(1.5);
  const std::string file =
      write_log(directory.path() / "x.rawlog", true, imu(1.0, 1.0, 0.0), blank, imu(2.0, 1.0, 0.0));
  EXPECT_THROW(
      {
        RawlogPlayer player(file, twist_options());
        play(player);
      },
      InputError);
  RawlogPlayer player(file, twist_options("skip"));
  EXPECT_EQ(play(player).size(), 1U);
  EXPECT_EQ(player.summary().skipped, 1);
}

// A sensor ahead of the centre of a turning robot moves sideways; turned by 90 degrees it calls
// that backwards.
TEST(VelocityInRawlog, IsMovedFromTheSensorToTheRobot) {
  mrpt::obs::CObservationIMU o = imu(0.0, 0.0, 2.0);
  o.sensorPose = mrpt::poses::CPose3D(0.5, 0.0, 0.0, -M_PI / 2, 0.0, 0.0);
  o.set(mrpt::obs::IMU_X_VEL, -2.0 * 0.5);
  const auto twist = body_velocity(o);
  ASSERT_TRUE(twist);
  EXPECT_LT(twist->head<3>().norm(), 1e-12);
  EXPECT_LT((twist->tail<3>() - Eigen::Vector3d(0, 0, 2)).norm(), 1e-12);
}

}  // namespace
}  // namespace libslam::test
