// The path that a sensor reports of itself: an observation to whoever names it, never the odometry.

#include <support/temporary_directory.hpp>

#include <gtest/gtest.h>

#include "log_builder.hpp"

namespace libslam::test {
namespace {

mrpt::obs::CObservationOdometry scan_matching(double time, double x) {
  mrpt::obs::CObservationOdometry reading = odometry(time, x, 0.0, 0.0);
  reading.sensorLabel = "scan_matching";
  return reading;
}

TEST(SensorPathInRawlog, ObservationOnlyLogKeepsItApartFromTheWheels) {
  const TemporaryDirectory directory;
  const std::string file = write_log(
      directory.path() / "x.rawlog", true, odometry(1.0, 0.0, 0.0, 0.0), scan_matching(1.0, 50.0),
      odometry(2.0, 0.1, 0.0, 0.0), scan_matching(2.0, 50.2), odometry(3.0, 0.3, 0.0, 0.0));
  PlayerOptions options = with_policy("strict");
  options.input.sensor_label = "scan_matching";
  RawlogPlayer player(file, options);
  double travelled = 0.0;
  std::vector<double> seen;
  for (const LogStep& step : play(player)) {
    if (const auto motion = motion_of(step)) travelled += motion->rawOdometryIncrementReading.x();
    if (!step.frame) continue;
    for (const auto& observation : *step.frame)
      seen.push_back(
          dynamic_cast<const mrpt::obs::CObservationOdometry&>(*observation).odometry.x());
  }
  EXPECT_DOUBLE_EQ(travelled, 0.3);
  EXPECT_EQ(seen, (std::vector<double>{50.0, 50.2}));
}

}  // namespace
}  // namespace libslam::test
