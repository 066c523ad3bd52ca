// LEGO robot of the SLAM lectures: raw ticks, raw scans, six cylinders.

#include <iostream>
#include <tests/golden/log_run.hpp>

#include <libslam/io/importers/brenner.hpp>

using namespace libslam;
using namespace libslam::test;

namespace {

const char* const kConfig = "brenner.yaml";

double path_error(const LogRun& run) {
  return run.summary.truth->path->aligned->rmse_m;
}

}  // namespace

// 173 mm is the constant that fits the reference positions best; the robot starts with 155 mm.
TEST(Brenner, TrackWidthIsFoundWhileDriving) {
  LIBSLAM_REQUIRE_DATA(directory, "brenner_lego_robot");
  const TemporaryDirectory scratch;
  const ImportedLog log = import_brenner(directory, {});
  const LogRun calibrated = run_imported(kConfig, log, scratch.path() / "calibrated");
  const LogRun uncalibrated = run_imported(kConfig, log, scratch.path() / "uncalibrated",
                                           {"calibration.track_width.enabled=false"});
  const double track = 0.155 * calibrated.calibration("track_width").mean;
  std::cout << "track " << 1e3 * track << " mm, path error calibrated "
            << 1e3 * path_error(calibrated) << " mm with " << calibrated.map.size()
            << " cylinders, uncalibrated " << 1e3 * path_error(uncalibrated) << " mm with "
            << uncalibrated.map.size() << "\n";
  EXPECT_TRUE(calibrated.calibration("track_width").observable);
  EXPECT_NEAR(track, 0.173, 0.003);
  EXPECT_LE(path_error(calibrated), 0.25 * path_error(uncalibrated));
  ASSERT_TRUE(calibrated.summary.truth->map);
  EXPECT_EQ(calibrated.summary.truth->map->missed, 0);
  EXPECT_LE(*calibrated.summary.truth->map->rmse_aligned_m, 0.03);
}

TEST(Brenner, ImportIsComplete) {
  LIBSLAM_REQUIRE_DATA(directory, "brenner_lego_robot");
  const ImportedLog log = import_brenner(directory, {});
  EXPECT_EQ(log.odometry.size(), 278u);
  EXPECT_EQ(log.laser_scans.size(), 278u);
  EXPECT_EQ(log.laser_scans.front().ranges.size(), 660u);
  EXPECT_EQ(log.truth.landmarks.size(), 6u);
  double driven = 0.0, seen = 0.0;
  for (const ImportedOdometry& reading : log.odometry) driven += std::abs(reading.arc.x());
  for (std::size_t i = 1; i < log.truth.path.poses.size(); ++i)
    seen += (log.truth.path.poses[i] - log.truth.path.poses[i - 1]).head<2>().norm();
  EXPECT_NEAR(seen, 9.35, 0.01);  // README of the data; of the laser, 3 cm ahead of the tracks
  EXPECT_NEAR(driven, 8.73, 0.01);
  for (const auto& scan : log.laser_scans) EXPECT_GE(scan.time, 0.0);
}
