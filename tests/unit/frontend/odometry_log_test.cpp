#include <gtest/gtest.h>
#include <mrpt/obs/CRawlog.h>

#include <libslam/frontend/odometry.hpp>

namespace libslam {
namespace {

/// The steps of a log of the packaged data that have an action.
std::vector<LogStep> steps_of(const std::string& name) {
  mrpt::obs::CRawlog log;
  EXPECT_TRUE(log.loadFromRawLogFile("/usr/share/mrpt/datasets/" + name));
  EXPECT_GT(log.size(), 0u) << name;
  std::vector<LogStep> steps;
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (log.getType(i) != mrpt::obs::CRawlog::etActionCollection) continue;
    LogStep step;
    step.index = static_cast<std::int64_t>(steps.size());
    step.dt = 0.25;  // of the order of the logs; enough to make velocities comparable
    step.has_motion_covariance = true;
    step.action = log.getAsAction(i);
    steps.push_back(step);
  }
  return steps;
}

TEST(OdometryOfPackagedLogs, WithoutOptionalFields) {
  for (const char* name : {"kf-slam_demo.rawlog", "RO-SLAM_demo.rawlog",
                           "2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"}) {
    OdometryReader reader{InputParameters()};
    for (const LogStep& step : steps_of(name)) {
      const auto action = reader.read(step);
      ASSERT_TRUE(action && action->cov_increment) << name;
      EXPECT_FALSE(action->velocity || action->ticks) << name;
    }
    EXPECT_TRUE(reader.warnings().empty()) << name;
    EXPECT_EQ(reader.velocities().verdict(), FieldVerdict::kAbsent) << name;
  }
}

TEST(OdometryOfPackagedLogs, GarbageFields) {
  for (const char* name : {"localization_demo.rawlog", "uwb_ro-localization_demo.rawlog"}) {
    OdometryReader reader{InputParameters()};
    for (const LogStep& step : steps_of(name)) {
      const auto action = reader.read(step);
      ASSERT_TRUE(action && action->increment.allFinite()) << name;
      EXPECT_FALSE(action->velocity || action->ticks) << name;
    }
    EXPECT_EQ(reader.velocities().verdict(), FieldVerdict::kInsane) << name;
    EXPECT_EQ(reader.ticks().verdict(), FieldVerdict::kInsane) << name;
    EXPECT_EQ(reader.warnings().size(), 2u) << name;
    InputParameters velocities;
    velocities.odometry = "velocities";
    OdometryReader asked(velocities);
    EXPECT_THROW(asked.read(steps_of(name).front()), std::invalid_argument) << name;
  }
}

TEST(OdometryOfPackagedLogs, SpatialLogIsNotPlanar) {
  OdometryReader reader{InputParameters()};
  std::int64_t refused = -1;
  try {
    for (const LogStep& step : steps_of("kf-slam_6D_demo.rawlog")) reader.read(step);
  } catch (const UnusableOdometry& error) {
    refused = error.step();
  }
  EXPECT_EQ(refused, 4);  // the robot stands for four steps
}

}  // namespace
}  // namespace libslam
