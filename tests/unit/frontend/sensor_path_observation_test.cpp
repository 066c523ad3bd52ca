#include <limits>

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <libslam/frontend/sensor_path_observation.hpp>

namespace libslam {
namespace {

void insert_reading(mrpt::obs::CSensoryFrame& frame, const char* label, double x) {
  auto reading = mrpt::obs::CObservationOdometry::Create();
  reading->sensorLabel = label;
  reading->odometry = {x, -2.0, 0.5};
  frame.insert(reading);
}

TEST(SensorPathObservation, TakesTheNamedPathWithTheConfiguredNoise) {
  MeasurementParameters measurement;
  measurement.sigma_displacement_xy = 0.002;
  measurement.sigma_displacement_heading_deg = 0.5;
  SensorPathObservation frontend(measurement, "scan_matching");
  mrpt::obs::CSensoryFrame frame;
  insert_reading(frame, "wheels", 7.0);
  insert_reading(frame, "scan_matching", 1.0);
  frame.insert(mrpt::obs::CObservationBearingRange::Create());
  std::vector<FeatureBatch> batches(3);
  frontend.extract(frame, batches);
  ASSERT_EQ(batches.size(), 1u);
  ASSERT_EQ(batches[0].size(), 1u);
  const Feature& reading = batches[0][0];
  EXPECT_EQ(Eigen::Vector3d(reading.z), Eigen::Vector3d(1.0, -2.0, 0.5));
  const double heading = 0.5 * kPi / 180.0;
  EXPECT_TRUE(
      Eigen::Matrix3d(reading.cov)
          .isApprox(Eigen::Matrix3d(Eigen::Vector3d(4e-6, 4e-6, heading * heading).asDiagonal())));
  EXPECT_EQ(frontend.unusable(), 0);
}

TEST(SensorPathObservation, CountsReadingsThatAreNoNumbers) {
  SensorPathObservation frontend({}, "scan_matching");
  mrpt::obs::CSensoryFrame frame;
  insert_reading(frame, "scan_matching", std::numeric_limits<double>::quiet_NaN());
  insert_reading(frame, "scan_matching", std::numeric_limits<double>::infinity());
  std::vector<FeatureBatch> batches;
  frontend.extract(frame, batches);
  EXPECT_TRUE(batches.empty());
  EXPECT_EQ(frontend.unusable(), 2);
}

}  // namespace
}  // namespace libslam
