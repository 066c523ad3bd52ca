#include <cstring>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <libslam/frontend/odometry.hpp>

namespace libslam {
namespace {

using mrpt::obs::CActionCollection;
using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CActionRobotMovement3D;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kPeriod = 0.1;

InputParameters input(const std::string& odometry, const std::string& policy = "skip") {
  InputParameters parameters;
  parameters.odometry = odometry;
  parameters.policy = policy;
  return parameters;
}

CActionRobotMovement2D movement(double dx, double dy, double dphi, double variance = 1e-4) {
  CActionRobotMovement2D action;
  action.poseChange = mrpt::poses::CPosePDFGaussian::Create(
      mrpt::poses::CPose2D(dx, dy, dphi),
      mrpt::math::CMatrixDouble33(Eigen::Matrix3d(variance * Eigen::Matrix3d::Identity())));
  return action;
}

LogStep step_of(const mrpt::obs::CAction& action, std::int64_t index = 0) {
  LogStep step;
  step.index = index;
  step.dt = kPeriod;
  step.time = kPeriod * static_cast<double>(index);
  step.action = CActionCollection::Create();
  step.action->insert(action);
  return step;
}

/// A robot with a track of 0.5 m and 1000 and 1100 ticks per metre that drives curves; its
/// velocities and ticks are `velocity_scale` and noise away from its increments.
class Drive {
 public:
  explicit Drive(std::uint64_t seed) : random_(seed) {}

  CActionRobotMovement2D next(double velocity_scale = 1.0) {
    std::normal_distribution<double> normal;
    const double ds = 0.05 + 0.01 * normal(random_), dphi = 0.02 * normal(random_);
    auto action = movement(ds * std::cos(dphi / 2), ds * std::sin(dphi / 2), dphi);
    action.hasVelocities = true;
    action.velocityLocal = {velocity_scale * ds / kPeriod, 0.0, velocity_scale * dphi / kPeriod};
    action.hasEncodersInfo = true;
    action.encoderLeftTicks = static_cast<int>(std::lround(1000 * (ds - 0.25 * dphi)));
    action.encoderRightTicks = static_cast<int>(std::lround(1100 * (ds + 0.25 * dphi)));
    return action;
  }

 private:
  std::mt19937_64 random_;
};

/// Feeds `count` steps of a drive, changed by `edit`, and returns the last action.
template <class Edit>
MotionAction feed(OdometryReader& reader, int count, const Edit& edit) {
  Drive drive(5);
  MotionAction last;
  for (int i = 0; i < count; ++i) {
    CActionRobotMovement2D action = drive.next();
    edit(action, i);
    last = reader.read(step_of(action, i)).value();
  }
  return last;
}

TEST(Odometry, PassesTheIncrementOn) {
  OdometryReader reader(input("auto"));
  LogStep step = step_of(movement(0.1, 0.02, -0.3), 7);
  auto action = reader.read(step).value();
  EXPECT_LT((action.increment - Eigen::Vector3d(0.1, 0.02, -0.3)).norm(), 1e-15);
  EXPECT_EQ(action.time, step.time);
  EXPECT_EQ(action.dt, step.dt);
  EXPECT_FALSE(action.cov_increment);  // computed by MRPT's default, not by the log
  EXPECT_FALSE(action.velocity);
  EXPECT_FALSE(action.ticks);
  step.has_motion_covariance = true;
  action = reader.read(step).value();
  EXPECT_EQ(*action.cov_increment, Eigen::Matrix3d(1e-4 * Eigen::Matrix3d::Identity()));
  EXPECT_TRUE(reader.warnings().empty());
}

TEST(Odometry, NothingWithoutMovement) {
  OdometryReader reader(input("auto"));
  EXPECT_FALSE(reader.read(LogStep{}));
  LogStep empty;
  empty.action = CActionCollection::Create();
  EXPECT_FALSE(reader.read(empty));
}

TEST(Odometry, TakesTheBestOfSeveralMovements) {
  LogStep step = step_of(movement(0.1, 0, 0, 1e-2));
  step.action->insert(movement(0.2, 0, 0, 1e-4));
  OdometryReader reader(input("auto"));
  EXPECT_DOUBLE_EQ(reader.read(step)->increment.x(), 0.2);
  // MRPT knows no best where every determinant exceeds 1e3.
  EXPECT_DOUBLE_EQ(reader.read(step_of(movement(0.3, 0, 0, 100.0)))->increment.x(), 0.3);
}

TEST(Odometry, PlanarThreeDimensionalMovementsAreAccepted) {
  CActionRobotMovement3D action;
  action.poseChange.mean = mrpt::poses::CPose3D(0.1, 0.02, 0, 0.3, 0, 0);
  for (int i = 0; i < 6; ++i) action.poseChange.cov(i, i) = i + 1;
  action.poseChange.cov(0, 3) = action.poseChange.cov(3, 0) = 0.5;
  LogStep step = step_of(action, 3);
  step.has_motion_covariance = true;
  OdometryReader reader(input("auto"));
  const auto read = reader.read(step).value();
  EXPECT_LT((read.increment - Eigen::Vector3d(0.1, 0.02, 0.3)).norm(), 1e-15);
  Eigen::Matrix3d expected;
  expected << 1, 0, 0.5, 0, 2, 0, 0.5, 0, 4;
  EXPECT_EQ(*read.cov_increment, expected);

  action.poseChange.mean = mrpt::poses::CPose3D(0.1, 0, 0.01, 0.3, 0, 0);
  try {
    reader.read(step_of(action, 12));
    FAIL() << "accepted";
  } catch (const UnusableOdometry& error) {
    EXPECT_EQ(error.step(), 12);
    EXPECT_NE(std::string(error.what()).find("step 12"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("CActionRobotMovement3D"), std::string::npos);
  }
}

TEST(Odometry, CorruptEntriesNameTheirStep) {
  OdometryReader reader(input("auto"));
  try {
    reader.read(step_of(movement(0.1, kNaN, 0), 42));
    FAIL() << "accepted";
  } catch (const UnusableOdometry& error) {
    EXPECT_EQ(error.step(), 42);
  }
  LogStep without = step_of(movement(0, 0, 0));  // as a corrupt file can leave it
  dynamic_cast<CActionRobotMovement2D&>(**without.action->begin()).poseChange.reset();
  EXPECT_THROW(reader.read(without), UnusableOdometry);
  LogStep step = step_of(movement(0, 0, 0));
  step.dt = -1.0;
  EXPECT_THROW(reader.read(step), UnusableOdometry);
  CActionRobotMovement3D spatial;
  spatial.poseChange.mean = mrpt::poses::CPose3D(0.1, 0, kNaN, 0, 0, 0);
  EXPECT_THROW(reader.read(step_of(spatial)), UnusableOdometry);
}

TEST(Odometry, BadCovariancesAreDroppedOrRefused) {
  for (const double variance : {kNaN, -1.0}) {
    LogStep step = step_of(movement(0.1, 0, 0, variance));
    step.has_motion_covariance = true;
    OdometryReader lenient(input("auto"));
    EXPECT_FALSE(lenient.read(step)->cov_increment);
    ASSERT_EQ(lenient.warnings().size(), 1u);
    EXPECT_NE(lenient.warnings()[0].find("1 covariances"), std::string::npos);
    OdometryReader strict(input("auto", "strict"));
    EXPECT_THROW(strict.read(step), UnusableOdometry);
  }
}

TEST(Odometry, SaneFieldsAreAttachedOnceChecked) {
  OdometryReader reader(input("auto"));
  const auto unchanged = [](auto&, int) {};
  MotionAction action = feed(reader, FieldCheck::kReadings - 1, unchanged);
  EXPECT_EQ(reader.velocities().verdict(), FieldVerdict::kUndecided);
  EXPECT_FALSE(action.velocity);
  OdometryReader longer(input("auto"));
  action = feed(longer, FieldCheck::kReadings, unchanged);
  EXPECT_EQ(longer.velocities().verdict(), FieldVerdict::kSane);
  EXPECT_EQ(longer.ticks().verdict(), FieldVerdict::kSane);
  EXPECT_TRUE(action.velocity);
  EXPECT_TRUE(action.ticks);
  EXPECT_TRUE(longer.warnings().empty());
}

TEST(Odometry, ChoiceOfTheField) {
  const auto unchanged = [](auto&, int) {};
  OdometryReader increments(input("increments")), velocities(input("velocities")),
      ticks(input("ticks"));
  MotionAction action = feed(increments, 60, unchanged);
  EXPECT_FALSE(action.velocity || action.ticks);
  action = feed(velocities, 1, unchanged);
  EXPECT_TRUE(action.velocity && !action.ticks);
  action = feed(ticks, 1, unchanged);
  EXPECT_TRUE(action.ticks && !action.velocity);
  EXPECT_EQ(ticks.warnings().size(), 1u);  // used, but not yet checked
  EXPECT_THROW(OdometryReader(input("wheels")), std::invalid_argument);
  EXPECT_THROW(OdometryReader(input("auto", "lax")), std::invalid_argument);
}

TEST(Odometry, VelocitiesWithinTheToleranceAreSane) {
  // The tolerance is 0.2: a scale of 1.19 passes, one of 1.21 does not.
  for (const double scale : {1.19, 1.21}) {
    const auto verdict = scale < 1.2 ? FieldVerdict::kSane : FieldVerdict::kInsane;
    OdometryReader reader(input("auto"));
    feed(reader, 50, [&](auto& action, int) {
      action.velocityLocal.vx *= scale;
      action.velocityLocal.omega *= scale;
    });
    EXPECT_EQ(reader.velocities().verdict(), verdict) << scale;
  }
}

/// Every kind of garbage ends insane, with a warning, and is never passed on.
template <class Edit>
void expect_garbage(const std::string& field, const Edit& edit) {
  OdometryReader reader(input("auto"));
  const MotionAction action = feed(reader, 120, edit);
  const bool velocities = field == "velocities";
  EXPECT_EQ((velocities ? reader.velocities() : reader.ticks()).verdict(), FieldVerdict::kInsane);
  EXPECT_FALSE(velocities ? action.velocity.has_value() : action.ticks.has_value());
  EXPECT_TRUE(velocities ? action.ticks.has_value() : action.velocity.has_value());
  ASSERT_EQ(reader.warnings().size(), 1u);
  EXPECT_NE(reader.warnings()[0].find(field), std::string::npos);
  OdometryReader asked(input(field));
  EXPECT_THROW(feed(asked, 120, edit), std::invalid_argument);
}

TEST(Odometry, GarbageVelocitiesAreRefused) {
  expect_garbage("velocities", [](auto& action, int) { action.velocityLocal = {0, 0, 0}; });
  expect_garbage("velocities", [](auto& action, int) { action.velocityLocal.omega = 4e33; });
  expect_garbage("velocities", [](auto& action, int i) {
    if (i == 70) action.velocityLocal.vx = kNaN;  // after the field was found sane
  });
  expect_garbage("velocities", [](auto& action, int) { action.velocityLocal.omega *= -1; });
  expect_garbage("velocities", [](auto& action, int) { action.velocityLocal.vx *= 3.6; });  // km/h
}

TEST(Odometry, GarbageTicksAreRefused) {
  expect_garbage("ticks", [](auto& action, int) {
    action.encoderLeftTicks = 2117699626;
    action.encoderRightTicks = 161;
  });
  expect_garbage("ticks",
                 [](auto& action, int) { action.encoderLeftTicks = action.encoderRightTicks = 0; });
  expect_garbage("ticks", [](auto& action, int i) {  // absolute counts, not increments
    action.encoderLeftTicks = 50 * i;
    action.encoderRightTicks = 51 * i;
  });
  expect_garbage("ticks", [](auto& action, int) {  // reversed sign convention
    action.encoderLeftTicks *= -1;
    action.encoderRightTicks *= -1;
  });
}

TEST(Odometry, APresenceFlagThatIsNoBoolIsGarbage) {
  expect_garbage("ticks", [](auto& action, int) {
    const unsigned char garbage = 249;
    std::memcpy(&action.hasEncodersInfo, &garbage, 1);
  });
}

TEST(Odometry, AbsentFieldsThrowWhenAskedFor) {
  for (const char* field : {"velocities", "ticks"}) {
    OdometryReader reader(input(field));
    try {
      reader.read(step_of(movement(0.1, 0, 0), 9));
      FAIL() << "accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("step 9"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos);
    }
  }
}

TEST(Odometry, VelocitiesWithoutTimesStayUndecided) {
  OdometryReader reader(input("velocities"));
  Drive drive(5);
  for (int i = 0; i < 80; ++i) {
    LogStep step = step_of(drive.next(), i);
    step.dt = 0.0;
    ASSERT_TRUE(reader.read(step)->velocity);
  }
  EXPECT_EQ(reader.velocities().verdict(), FieldVerdict::kUndecided);
  EXPECT_EQ(reader.warnings().size(), 1u);
}

}  // namespace
}  // namespace libslam
