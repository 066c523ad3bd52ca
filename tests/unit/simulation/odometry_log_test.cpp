#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/obs/CActionRobotMovement2D.h>

#include <libslam/pipeline/factory.hpp>
#include <libslam/state/planar_pose.hpp>

#include "drive_fixture.hpp"

namespace libslam {
namespace {

using namespace libslam::testing;

constexpr double kDt = 0.025;

InputParameters driven_by(const char* odometry) {
  InputParameters input;
  input.odometry = odometry;
  return input;
}

SimulatedVehicle nominal_vehicle(const Scenario& s) {
  const InputParameters logged = driven_by(s.log.odometry.c_str());
  return {make_motion_model(s.motion, {}, driven_by("velocities")),
          make_motion_model(s.motion, {}, logged), make_motion_model(s.motion, {}, logged)};
}

mrpt::obs::CActionRobotMovement2D::Ptr taken(OdometryLog& log) {
  const auto actions = log.take(mrpt::Clock::fromDouble(1000.0));
  return actions->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
}

TEST(OdometryLog, SeedFormLogsTheIncrementOfItsEquations) {
  const Scenario s = small_scenario();
  const SimulatedVehicle vehicle = nominal_vehicle(s);
  OdometryLog log(s, vehicle);
  const double gamma = 0.3, travel = 3.0 * kDt;
  const MotionAction action = log.add({3.0, 3.0 * std::tan(gamma) / 4.0}, 1000.0, kDt);
  EXPECT_NEAR(action.increment.x(), travel * std::cos(gamma), 1e-15);
  EXPECT_NEAR(action.increment.y(), travel * std::sin(gamma), 1e-15);
  EXPECT_NEAR(action.increment.z(), travel * std::tan(gamma) / 4.0, 1e-15);
  EXPECT_FALSE(action.velocity.has_value());
  EXPECT_FALSE(action.cov_increment.has_value());
}

TEST(OdometryLog, CovarianceIsThatOfTheConfiguredNoise) {
  const Scenario s = small_scenario();
  const SimulatedVehicle vehicle = nominal_vehicle(s);
  OdometryLog log(s, vehicle);
  log.add({3.0, 0.0}, 1000.0, kDt);
  const auto motion = taken(log);
  ASSERT_TRUE(log.has_covariance());
  mrpt::math::CMatrixDouble33 cov;
  motion->poseChange->getCovariance(cov);
  // Straight on: travel noise along x; steering noise turns the step (y) and the heading (tan).
  const double travel = 3.0 * kDt, sigma_gamma = 0.005 / std::sqrt(kDt);
  EXPECT_NEAR(cov(0, 0), 0.02 * 0.02 * kDt, 1e-12);
  EXPECT_NEAR(cov(1, 1), std::pow(travel * sigma_gamma, 2), 1e-12);
  EXPECT_NEAR(cov(2, 2), std::pow(travel * sigma_gamma / 4.0, 2), 1e-12);
  EXPECT_EQ(cov.asEigen(), cov.asEigen().transpose());
}

TEST(OdometryLog, ComposesIncrementsAndCovariances) {
  const Scenario s = small_scenario();
  const SimulatedVehicle vehicle = nominal_vehicle(s);
  OdometryLog one_by_one(s, vehicle), merged(s, vehicle);
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector2d command(3.0, 0.1 * i);
    pose = compose_poses(pose, one_by_one.add(command, 1000.0 + i * kDt, kDt).increment);
    merged.add(command, 1000.0 + i * kDt, kDt);
  }
  const auto motion = taken(merged);
  const mrpt::poses::CPose2D mean = motion->poseChange->getMeanVal();
  EXPECT_LT((Eigen::Vector3d(mean.x(), mean.y(), mean.phi()) - pose).norm(), 1e-14);
  // The parts are taken from the log again, not from the composition.
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  OdometryLog parts(s, vehicle);
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (int i = 0; i < 8; ++i) {
    const MotionAction action = parts.add({3.0, 0.1 * i}, 1000.0 + i * kDt, kDt);
    mrpt::math::CMatrixDouble33 cov;
    taken(parts)->poseChange->getCovariance(cov);
    const Eigen::Vector3d after = compose_poses(before, action.increment);
    // An error of the part turns with the heading; one of the heading moves all that follows.
    const Eigen::Vector2d rest = pose.head<2>() - after.head<2>();
    Eigen::Matrix3d to_end = Eigen::Matrix3d::Identity();
    to_end.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(before.z()).toRotationMatrix();
    to_end(0, 2) = -rest.y();
    to_end(1, 2) = rest.x();
    expected += to_end * cov.asEigen() * to_end.transpose();
    before = after;
  }
  mrpt::math::CMatrixDouble33 cov;
  motion->poseChange->getCovariance(cov);
  EXPECT_LT((cov.asEigen() - expected).norm(), 1e-12 * expected.norm());
}

TEST(OdometryLog, TicksAreTheRoundedTotalAndTheIncrementFollowsThem) {
  Scenario s = differential_scenario();
  s.log.odometry = "ticks";
  s.motion.metres_per_tick_left = 0.003;
  s.motion.metres_per_tick_right = 0.002;
  const SimulatedVehicle vehicle = nominal_vehicle(s);
  OdometryLog log(s, vehicle);
  Eigen::Vector2d ticks = Eigen::Vector2d::Zero(), travel = Eigen::Vector2d::Zero();
  for (int i = 1; i <= 1000; ++i) {
    const Eigen::Vector2d command(0.31, 0.4 * std::sin(0.01 * i));
    const MotionAction action = log.add(command, 1000.0 + i * kDt, kDt);
    ASSERT_TRUE(action.ticks.has_value());
    ticks += *action.ticks;
    travel +=
        kDt * Eigen::Vector2d(command.x() - command.y() * 0.25, command.x() + command.y() * 0.25);
    EXPECT_LE(std::abs(ticks.x() * 0.003 - travel.x()), 0.0015 + 1e-12);
    EXPECT_LE(std::abs(ticks.y() * 0.002 - travel.y()), 0.001 + 1e-12);
    const double turn = (0.002 * action.ticks->y() - 0.003 * action.ticks->x()) / 0.5;
    EXPECT_NEAR(action.increment.z(), turn, 1e-14);
  }
}

TEST(OdometryLog, VelocitiesAreTheCommand) {
  Scenario s = differential_scenario();
  s.log.odometry = "velocities";
  const SimulatedVehicle vehicle = nominal_vehicle(s);
  OdometryLog log(s, vehicle);
  log.add({0.7, 0.3}, 1000.0, 0.0251);
  const auto motion = taken(log);
  EXPECT_TRUE(motion->hasVelocities);
  EXPECT_EQ(motion->velocityLocal.vx, 0.7);
  EXPECT_EQ(motion->velocityLocal.omega, 0.3);
  EXPECT_FALSE(motion->hasEncodersInfo);
}

}  // namespace
}  // namespace libslam
