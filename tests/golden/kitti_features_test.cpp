// KITTI drives with tracked stereo points: odometry in space with the biases of the gyros. The
// tracks of these data freeze where features were detected anew (91 frames of drive 0027).

#include <tests/golden/spatial_run.hpp>
#include <utility>

#include <libslam/io/importers/kitti_features.hpp>

using namespace libslam;
using namespace libslam::test;

namespace {

constexpr const char* kConfig = "kitti_features.yaml";

}  // namespace

TEST(KittiFeatures, Drive0027WithNoisyVelocities) {
  LIBSLAM_REQUIRE_DATA(data, "kitti_stereo_features/drive_0027_noisy");
  const TemporaryDirectory scratch;
  const SpatialLog log = import_kitti_features(data);
  const LogRun run = run_spatial(kConfig, log, scratch.path() / "run");
  const LogRun reckoned =
      run_spatial(kConfig, log, scratch.path() / "reckoned", {"frontend.max_range=0.1"});
  const TruthComparison& truth = *run.summary.truth;
  EXPECT_LE(truth.path->raw->rmse_m, 12.0);
  EXPECT_LE(truth.relative->trans_percent, 2.2);
  EXPECT_LE(truth.nees->mean, 20.0);
  EXPECT_LE(truth.path->raw->rmse_m, 0.30 * reckoned.summary.truth->path->raw->rmse_m);
  for (const char* axis : {"bias_gyro_x", "bias_gyro_y", "bias_gyro_z"})
    EXPECT_NEAR(run.calibration(axis).mean, 0.0046, 0.002) << axis;
}

// Few points and good velocities: what improves is the error over short distances.
TEST(KittiFeatures, SparseDrivesWithCleanVelocities) {
  LIBSLAM_REQUIRE_DATA(data, "kitti_stereo_features");
  const TemporaryDirectory scratch;
  for (const auto& [drive, bound] :
       {std::pair("drive_0027_sparse", 0.65), std::pair("drive_0020_sparse", 0.80)}) {
    const SpatialLog log = import_kitti_features((std::filesystem::path(data) / drive).string());
    const LogRun run = run_spatial("kitti_features_sparse.yaml", log, scratch.path() / "run");
    const LogRun reckoned = run_spatial("kitti_features_sparse.yaml", log,
                                        scratch.path() / "reckoned", {"frontend.max_range=0.1"});
    EXPECT_LE(run.summary.truth->relative->trans_percent,
              bound * reckoned.summary.truth->relative->trans_percent)
        << drive;
  }
}
