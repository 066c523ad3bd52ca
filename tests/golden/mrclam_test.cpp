// UTIAS MRCLAM 6: five real robots, 15 barcode landmarks, known identities, one configuration.

#include <tests/golden/log_run.hpp>

#include <libslam/io/importers/mrclam.hpp>

using namespace libslam;
using namespace libslam::test;

TEST(Mrclam, FiveRobotsWithOneConfiguration) {
  LIBSLAM_REQUIRE_DATA(directory, "mrclam/MRCLAM_Dataset6");
  const TemporaryDirectory scratch;
  constexpr int kRobots = 5;
  double path_sum = 0.0, map_sum = 0.0;
  for (int robot = 1; robot <= kRobots; ++robot) {
    const LogRun run =
        run_imported("mrclam.yaml", import_mrclam(directory, robot), scratch.path() / "run");
    const TruthComparison& truth = *run.summary.truth;
    EXPECT_EQ(truth.map->matched, 15) << "robot " << robot;
    EXPECT_LE(truth.path->raw->rmse_m, 0.65) << "robot " << robot;
    EXPECT_LE(*truth.map->rmse_aligned_m, 0.15) << "robot " << robot;
    EXPECT_LE(truth.nees->median, 4.0) << "robot " << robot;
    path_sum += truth.path->raw->rmse_m;
    map_sum += *truth.map->rmse_aligned_m;
  }
  EXPECT_LE(path_sum / kRobots, 0.45);
  EXPECT_LE(map_sum / kRobots, 0.11);
}

// No true path is published with this one: the map alone. Barriers hide landmarks.
TEST(Mrclam, ASisterDataSetWithBarriers) {
  LIBSLAM_REQUIRE_DATA(directory, "mrclam/MRCLAM_Dataset9");
  const TemporaryDirectory scratch;
  double map_sum = 0.0;
  for (int robot = 1; robot <= 5; ++robot) {
    const LogRun run =
        run_imported("mrclam.yaml", import_mrclam(directory, robot), scratch.path() / "run");
    ASSERT_TRUE(run.summary.truth && run.summary.truth->map) << "robot " << robot;
    EXPECT_EQ(run.summary.truth->map->matched, 15) << "robot " << robot;
    EXPECT_LE(*run.summary.truth->map->rmse_aligned_m, 0.15) << "robot " << robot;
    map_sum += *run.summary.truth->map->rmse_aligned_m;
  }
  EXPECT_LE(map_sum / 5, 0.11);
}
