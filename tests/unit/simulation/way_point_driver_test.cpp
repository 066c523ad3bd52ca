#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <libslam/simulation/way_point_driver.hpp>

namespace libslam {
namespace {

constexpr double kDegree = kPi / 180.0;

MotionParameters model(const char* name) {
  MotionParameters motion;
  motion.model = name;
  motion.wheelbase = 4.0;
  return motion;
}

double steering_of(const Eigen::Vector2d& command) {
  return std::atan(command.y() * 4.0 / command.x());
}

TEST(WayPointDriver, SteersNoFasterAndNoFurtherThanItsLimits) {
  DriveParameters drive;
  WayPointDriver driver(drive, model("ackermann"), {{0.0, 100.0}});
  double before = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double now = steering_of(driver.command({0, 0, 0}, 0.025));
    EXPECT_LE(std::abs(now - before), 20.0 * kDegree * 0.025 + 1e-12);
    before = now;
  }
  EXPECT_NEAR(before, 45.0 * kDegree, 1e-12);
}

TEST(WayPointDriver, DifferentialTurnsOnTheSpotTowardsWhatIsBehind) {
  DriveParameters drive;
  WayPointDriver driver(drive, model("differential"), {{-10.0, 0.1}});
  const Eigen::Vector2d command = driver.command({0, 0, 0}, 0.025);
  EXPECT_EQ(command.x(), 0.0);
  EXPECT_NEAR(command.y(), 60.0 * kDegree, 1e-12);
}

TEST(WayPointDriver, CountsLaps) {
  DriveParameters drive;
  drive.laps = 2;
  WayPointDriver driver(drive, model("ackermann"), {{0, 0}, {10, 0}});
  EXPECT_FALSE(driver.arrive({0.5, 0, 0}));
  EXPECT_EQ(driver.reached(), 1U);
  EXPECT_FALSE(driver.arrive({9.5, 0, 0}));
  EXPECT_DOUBLE_EQ(driver.progress(), 0.5);
  EXPECT_FALSE(driver.arrive({0, 0, 0}));
  EXPECT_TRUE(driver.arrive({10, 0, 0}));
  EXPECT_DOUBLE_EQ(driver.length_from({-1, 0}), 1.0 + 2 * 20.0);
}

TEST(WayPointDriver, NeedsWayPoints) {
  EXPECT_THROW(WayPointDriver(DriveParameters(), model("ackermann"), {}), std::invalid_argument);
}

}  // namespace
}  // namespace libslam
