// Victoria Park, Sydney: real truck, 4 km, tree trunks.

#include <tests/golden/batch_landmark_slam.hpp>
#include <tests/golden/log_run.hpp>

#include <libslam/io/importers/victoria_park.hpp>
#include <libslam/result/alignment.hpp>

using namespace libslam;
using namespace libslam::test;

namespace {

const char* const kConfig = "victoria_park.yaml";
const std::vector<std::string> kUncalibrated = {"calibration.scale_speed.enabled=false",
                                                "calibration.scale_steering.enabled=false",
                                                "calibration.bias_steering.enabled=false"};

VictoriaParkOptions distorted(double speed, double steering, double bias) {
  VictoriaParkOptions options;
  options.distortion = {speed, steering, bias};
  return options;
}

double gps_rmse(const LogRun& run) {
  return run.summary.truth->path->aligned->rmse_m;
}

}  // namespace

TEST(VictoriaPark, GpsErrorAndLandmarksFromTreeDetections) {
  LIBSLAM_REQUIRE_DATA(directory, "victoria_park");
  const TemporaryDirectory scratch;
  const LogRun run =
      run_imported(kConfig, import_victoria_park(directory, {}), scratch.path() / "run");
  ASSERT_TRUE(run.summary.truth && run.summary.truth->path);
  EXPECT_GE(run.summary.truth->path->poses, 940);
  EXPECT_LE(gps_rmse(run), 1.9);
  EXPECT_LE(run.summary.truth->path->aligned->mean_m, 1.5);
  EXPECT_GE(run.map.size(), 220u);
  EXPECT_LE(run.map.size(), 280u);
}

TEST(VictoriaPark, BothSteeringCalibrationsGiveOnePathAndTheirRatio) {
  LIBSLAM_REQUIRE_DATA(directory, "victoria_park");
  const TemporaryDirectory scratch;
  VictoriaParkOptions drs;
  drs.steering = VictoriaParkOptions::Steering::kDrs;
  const LogRun a =
      run_imported(kConfig, import_victoria_park(directory, {}), scratch.path() / "aa3");
  const LogRun b =
      run_imported(kConfig, import_victoria_park(directory, drs), scratch.path() / "drs");
  EXPECT_NEAR(a.calibration("scale_steering").mean / b.calibration("scale_steering").mean, 1.0592,
              0.001);
  const PathDifference difference = compare_paths(a, b);
  EXPECT_GT(difference.poses, 10000);
  EXPECT_LE(difference.max, 0.05);
}

TEST(VictoriaPark, FalsifiedLogsStayOnThePathThatTheUncalibratedFilterLoses) {
  LIBSLAM_REQUIRE_DATA(directory, "victoria_park");
  const TemporaryDirectory scratch;
  const LogRun honest =
      run_imported(kConfig, import_victoria_park(directory, {}), scratch.path() / "honest");
  for (const auto& options : {distorted(1.03, 0.97, 0.0087), distorted(0.97, 1.03, -0.005)}) {
    const ImportedLog log = import_victoria_park(directory, options);
    const LogRun calibrated = run_imported(kConfig, log, scratch.path() / "calibrated");
    const PathDifference difference = compare_paths(honest, calibrated);
    EXPECT_GT(difference.poses, 10000);
    EXPECT_LE(difference.rms, 0.05);
    EXPECT_NEAR(honest.calibration("scale_speed").mean / calibrated.calibration("scale_speed").mean,
                options.distortion.speed, 0.002);
    const LogRun uncalibrated =
        run_imported(kConfig, log, scratch.path() / "uncalibrated", kUncalibrated);
    EXPECT_GE(gps_rmse(uncalibrated), 3.0 * gps_rmse(calibrated));
  }
}

TEST(VictoriaPark, KnownAssociationComesCloseToTheBatchOptimum) {
  LIBSLAM_REQUIRE_DATA(directory, "victoria_park");
  const TemporaryDirectory scratch;
  VictoriaParkOptions isam;
  isam.association = VictoriaParkOptions::Association::kIsam;
  const ImportedLog log = import_victoria_park(directory, isam);
  const LogRun run = run_imported("victoria_park_known_ids.yaml", log, scratch.path() / "run");
  const LogRun standard =
      run_imported("victoria_park_known_ids.yaml", log, scratch.path() / "standard",
                   {"filter.error_frame=standard"});
  BatchEstimate start;
  start.poses.push_back(Eigen::Vector3d::Zero());
  for (const auto& pose : run.path) start.poses.push_back(pose.pose);
  if (start.poses.size() > log.odometry.size()) start.poses.erase(start.poses.begin());
  ASSERT_EQ(start.poses.size(), log.odometry.size());
  for (const auto& landmark : run.map) start.landmarks[landmark.id] = landmark.mean;
  const BatchEstimate batch = optimize(log, start);
  EXPECT_TRUE(batch.converged);

  const auto distances = [&](const LogRun& estimate, bool aligned) {
    Eigen::Matrix2Xd ours(2, static_cast<Eigen::Index>(estimate.map.size())), best = ours;
    Eigen::Index i = 0;
    for (const auto& landmark : estimate.map) {
      ours.col(i) = landmark.mean;
      best.col(i++) = batch.landmarks.at(landmark.id);
    }
    if (aligned) {
      const auto fit = fit_rigid(ours, best);
      for (Eigen::Index k = 0; k < i; ++k) ours.col(k) = transform_point(*fit, ours.col(k));
    }
    return std::sqrt((ours - best).colwise().squaredNorm().mean());
  };
  EXPECT_EQ(run.map.size(), 151u);
  EXPECT_LE(distances(run, false), 1.4);
  EXPECT_LE(distances(run, true), 0.75);
  EXPECT_GT(distances(standard, false), 5.0 * distances(run, false));
  std::cout << "landmarks against the batch optimum, RMSE [m]: right-invariant "
            << distances(run, false) << " raw, " << distances(run, true) << " aligned; standard "
            << distances(standard, false) << " raw\n";
}
