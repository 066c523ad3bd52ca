// UTIAS Lost in the Woods: real robot, 17 tubes, 341 m, identities removed.

#include <tests/golden/batch_run.hpp>

#include <libslam/io/importers/lost_in_the_woods.hpp>

using namespace libslam;
using namespace libslam::test;

namespace {

const char* const kConfig = "lost_in_the_woods.yaml";
const char* const kData = "utias_lost_in_the_woods";
constexpr double kVirtualTrack = 0.5, kLeft = 1.04, kRight = 0.98;

// Odometry noise of the published variances and less: 0.6 of their sigma instead of sqrt(10).
const std::vector<std::string> kTrustedOdometry = {"motion.noise.along_per_sqrt_s=0.0126",
                                                   "motion.noise.turn_per_sqrt_s=0.0172"};
const std::vector<std::string> kUncalibrated = {"calibration.scale_left.enabled=false",
                                                "calibration.scale_right.enabled=false"};

ImportedLog log_without_identities(const std::string& directory) {
  ImportedLog log = import_lost_in_the_woods(directory);
  strip_identities(log);
  return log;
}

}  // namespace

TEST(LostInTheWoods, MapPathAndConsistencyWithoutIdentities) {
  LIBSLAM_REQUIRE_DATA(directory, kData);
  const TemporaryDirectory scratch;
  const LogRun run =
      run_imported(kConfig, log_without_identities(directory), scratch.path() / "run");
  EXPECT_EQ(run.map.size(), 17u);
  const TruthComparison& truth = *run.summary.truth;
  EXPECT_LE(*truth.map->rmse_aligned_m, 0.03);
  EXPECT_LE(*truth.map->rmse_m, 0.05);
  EXPECT_LE(truth.path->raw->rmse_m, 0.08);
  for (const auto& quarter : truth.nees->quarter_mean) {
    ASSERT_TRUE(quarter.has_value());
    EXPECT_GE(*quarter, 2.0);
    EXPECT_LE(*quarter, 5.0);
  }
}

TEST(LostInTheWoods, TheStandardFrameIsThreeTimesWorseWithTheSameCalibration) {
  LIBSLAM_REQUIRE_DATA(directory, kData);
  const TemporaryDirectory scratch;
  const ImportedLog log = log_without_identities(directory);
  const LogRun invariant = run_imported(kConfig, log, scratch.path() / "invariant");
  const LogRun standard =
      run_imported(kConfig, log, scratch.path() / "standard", {"filter.error_frame=standard"});
  EXPECT_GE(*standard.summary.truth->map->rmse_m, 3.0 * *invariant.summary.truth->map->rmse_m);
}

TEST(LostInTheWoods, AFalsifiedLogIsSeenThrough) {
  LIBSLAM_REQUIRE_DATA(directory, kData);
  const TemporaryDirectory scratch;
  const ImportedLog honest = log_without_identities(directory);
  ImportedLog falsified = honest;
  distort_wheels(falsified, kLeft, kRight, kVirtualTrack);
  const LogRun before = run_imported(kConfig, honest, scratch.path() / "honest");
  const LogRun after = run_imported(kConfig, falsified, scratch.path() / "falsified");
  EXPECT_NEAR(before.calibration("scale_left").mean / after.calibration("scale_left").mean, kLeft,
              0.002);
  EXPECT_NEAR(before.calibration("scale_right").mean / after.calibration("scale_right").mean,
              kRight, 0.002);
  EXPECT_TRUE(after.calibration("scale_left").observable);

  std::vector<std::string> settings = kTrustedOdometry;
  const LogRun calibrated =
      run_imported(kConfig, falsified, scratch.path() / "calibrated", settings);
  settings.insert(settings.end(), kUncalibrated.begin(), kUncalibrated.end());
  const LogRun uncalibrated =
      run_imported(kConfig, falsified, scratch.path() / "uncalibrated", settings);
  EXPECT_LE(calibrated.summary.truth->path->raw->rmse_m, 0.10);
  EXPECT_EQ(calibrated.map.size(), 17u);
  EXPECT_GT(uncalibrated.summary.truth->path->raw->rmse_m, 1.0);
}

// The map against the truth beside the optimum's. The path of a filter is what it knew at the time:
// its measure is the optimum over the log up to each moment, not the smoothed path.
TEST(LostInTheWoods, MapAndPathAreWithinTenPercentOfTheBatchOptimum) {
  LIBSLAM_REQUIRE_DATA(directory, kData);
  const TemporaryDirectory scratch;
  const BatchRun run = batch_imported(kConfig, log_without_identities(directory), scratch, {}, 30);
  EXPECT_TRUE(run.batch.converged);
  const MapErrors& filter = *run.comparison.filter.truth->map;
  const MapErrors& batch = *run.comparison.batch.truth->map;
  EXPECT_EQ(filter.matched, 17);
  EXPECT_LE(*filter.rmse_aligned_m, 1.1 * *batch.rmse_aligned_m);
  EXPECT_LE(*filter.rmse_m, 1.1 * *batch.rmse_m);
  const OnLineComparison& on_line = *run.comparison.on_line;
  EXPECT_LE(on_line.filter->raw->rmse_m, 1.1 * on_line.batch->raw->rmse_m);
  EXPECT_LE(on_line.distance_rmse_m, 0.005);
  // One sigma of the calibration is 0.0057.
  for (std::size_t i = 0; i < 2; ++i) {
    const CalibrationValue& best = run.comparison.batch.calibration[i];
    EXPECT_LE(std::abs(run.comparison.filter.calibration[i].mean - best.mean), 0.25 * best.sigma);
    EXPECT_NEAR(run.comparison.filter.calibration[i].sigma / best.sigma, 1.0, 0.05);
  }
  std::cout << "filter and batch, RMSE [m]: map aligned " << *filter.rmse_aligned_m << " "
            << *batch.rmse_aligned_m << ", raw " << *filter.rmse_m << " " << *batch.rmse_m
            << "; path on line " << on_line.filter->raw->rmse_m << " " << on_line.batch->raw->rmse_m
            << "; smoothed path " << run.comparison.batch.truth->path->raw->rmse_m << "\n";
}
