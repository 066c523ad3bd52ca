// Victoria Park from the raw scans of its laser: the trunks are found here.

#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <tests/golden/log_run.hpp>

#include <libslam/frontend/trunk_detection.hpp>
#include <libslam/io/importers/victoria_park.hpp>

using namespace libslam;
using namespace libslam::test;

namespace {

const char* const kConfig = "victoria_park_laser.yaml";

ImportedLog raw_scans(const std::string& directory,
                      VictoriaParkOptions::Steering steering = VictoriaParkOptions::Steering::kAa3,
                      const AckermannDistortion& distortion = {}) {
  VictoriaParkOptions options;
  options.association = VictoriaParkOptions::Association::kRawScans;
  options.steering = steering;
  options.distortion = distortion;
  return import_victoria_park(directory, options);
}

double gps_rmse(const LogRun& run) {
  return run.summary.truth->path->aligned->rmse_m;
}

/// (range, bearing) of what is seen at one time.
using Sightings = std::vector<Eigen::Vector2d>;

double distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const auto point = [](const Eigen::Vector2d& z) {
    return Eigen::Vector2d(z[0] * std::cos(z[1]), z[0] * std::sin(z[1]));
  };
  return (point(a) - point(b)).norm();
}

std::size_t matched(const Sightings& these, const Sightings& those) {
  constexpr double kSamePlace = 0.5;  // [m]; trunks stand metres apart
  std::size_t count = 0;
  for (const auto& a : these)
    for (const auto& b : those)
      if (distance(a, b) < kSamePlace) {
        ++count;
        break;
      }
  return count;
}

std::vector<Sightings> our_trunks(const ImportedLog& log, const FrontendParameters& frontend) {
  TrunkDetector detector(frontend.trunks);
  std::vector<Sightings> all;
  std::vector<DetectedTrunk> trunks;
  for (const ImportedLaserScan& scan : log.laser_scans) {
    std::vector<double> ranges;
    for (const float r : scan.ranges)
      ranges.push_back(r < log.laser.max_range ? r : std::numeric_limits<double>::infinity());
    detector.detect({ranges, log.laser.first_bearing, log.laser.resolution}, trunks);
    Sightings& sightings = all.emplace_back();
    for (const DetectedTrunk& trunk : trunks)
      if (trunk.range > frontend.min_range && trunk.range < frontend.max_range)
        sightings.emplace_back(trunk.range, trunk.bearing);
  }
  return all;
}

}  // namespace

TEST(VictoriaParkLaser, GpsErrorTreesAndOnePathForBothSteeringCalibrations) {
  LIBSLAM_REQUIRE_DATA(directory, "victoria_park");
  const TemporaryDirectory scratch;
  const LogRun a = run_imported(kConfig, raw_scans(directory), scratch.path() / "aa3");
  ASSERT_TRUE(a.summary.truth && a.summary.truth->path);
  EXPECT_GE(a.summary.truth->path->poses, 940);
  EXPECT_LE(gps_rmse(a), 1.9);
  EXPECT_GE(a.map.size(), 220u);
  EXPECT_LE(a.map.size(), 280u);
#ifdef NDEBUG
  EXPECT_LE(a.summary.timing.cpu_s, 10.0);  // detection included; measured 2.3
#endif
  const LogRun b = run_imported(kConfig, raw_scans(directory, VictoriaParkOptions::Steering::kDrs),
                                scratch.path() / "drs");
  EXPECT_NEAR(a.calibration("scale_steering").mean / b.calibration("scale_steering").mean, 1.0592,
              0.001);
  const PathDifference difference = compare_paths(a, b);
  EXPECT_GT(difference.poses, 10000);
  EXPECT_LE(difference.max, 0.05);
  std::cout << "GPS RMSE " << gps_rmse(a) << " and " << gps_rmse(b) << " m, " << a.map.size()
            << " and " << b.map.size() << " trees, paths within " << difference.max << " m, CPU "
            << a.summary.timing.cpu_s << " s, of which detection "
            << a.summary.timing.phases.at("extract") << " s\n";
}

TEST(VictoriaParkLaser, AFalsifiedLogStaysOnThePath) {
  LIBSLAM_REQUIRE_DATA(directory, "victoria_park");
  const TemporaryDirectory scratch;
  const AckermannDistortion distortion{1.03, 0.97, 0.0087};
  const LogRun honest = run_imported(kConfig, raw_scans(directory), scratch.path() / "honest");
  const ImportedLog falsified =
      raw_scans(directory, VictoriaParkOptions::Steering::kAa3, distortion);
  const LogRun calibrated = run_imported(kConfig, falsified, scratch.path() / "calibrated");
  EXPECT_LE(compare_paths(honest, calibrated).rms, 0.05);
  EXPECT_NEAR(honest.calibration("scale_speed").mean / calibrated.calibration("scale_speed").mean,
              distortion.speed, 0.002);
  const LogRun uncalibrated = run_imported(
      kConfig, falsified, scratch.path() / "uncalibrated",
      {"calibration.scale_speed.enabled=false", "calibration.scale_steering.enabled=false",
       "calibration.bias_steering.enabled=false"});
  EXPECT_GE(gps_rmse(uncalibrated), 3.0 * gps_rmse(calibrated));
  std::cout << "falsified: GPS RMSE calibrated " << gps_rmse(calibrated) << " m, uncalibrated "
            << gps_rmse(uncalibrated) << " m\n";
}

// The published detections are those of another detector on the same scans, not the truth.
TEST(VictoriaParkLaser, TrunksAreThoseOfThePublishedDetections) {
  LIBSLAM_REQUIRE_DATA(directory, "victoria_park");
  const FrontendParameters frontend =
      load_yaml(std::filesystem::path(LIBSLAM_CONFIG_DIR) / kConfig).frontend;
  VictoriaParkOptions options;
  options.max_diameter = frontend.trunks.max_diameter;
  std::map<std::int64_t, Sightings> published;  // by milliseconds
  for (const ImportedScan& scan : import_victoria_park(directory, options).scans)
    for (const ImportedSighting& s : scan.sightings)
      if (s.range > frontend.min_range && s.range < frontend.max_range)
        published[std::llround(1e3 * scan.time)].emplace_back(s.range, s.bearing);
  const ImportedLog log = raw_scans(directory);
  const auto ours = our_trunks(log, frontend);
  std::size_t found = 0, theirs = 0, right = 0, all = 0;
  for (std::size_t k = 0; k < ours.size(); ++k) {
    const Sightings& those = published[std::llround(1e3 * log.laser_scans[k].time)];
    found += matched(those, ours[k]);
    theirs += those.size();
    right += matched(ours[k], those);
    all += ours[k].size();
  }
  const double recall = static_cast<double>(found) / static_cast<double>(theirs);
  const double precision = static_cast<double>(right) / static_cast<double>(all);
  std::cout << "recall " << recall << " of " << theirs << ", precision " << precision << " of "
            << all << "\n";
  EXPECT_GE(recall, 0.9);
  EXPECT_GE(precision, 0.9);
}
