// Real buildings from CARMEN logs, against the relations of the Freiburg SLAM benchmark. One run
// each at the shipped distance between updates; tools/buildings runs more distances and variants.

#include <filesystem>
#include <tests/golden/log_run.hpp>

#include <libslam/io/importers/carmen.hpp>

using namespace libslam;
using namespace libslam::test;

namespace {

LogRun map_building(const std::string& data, const std::string& name, const std::string& config,
                    const std::filesystem::path& directory,
                    const std::vector<std::string>& settings = {}) {
  const std::string rawlog = (directory / (name + ".rawlog")).string();
  import_carmen(data + "/" + name + "/" + name + ".clf.gz", rawlog, {});
  return run_log(config, rawlog, directory / "run", settings);
}

const RelationErrors& smoothed(const LogRun& run) {
  return run.summary.truth->relations_smoothed.value();
}

const std::vector<std::string> kNoLoops{"filter.loop_closure.enabled=false"};

}  // namespace

// The bars of a grid-based particle filter are .060 m (ACES) and .070 m (Intel); Kuemmerle et
// al. 2009. Measured over five distances: .053 and .038 m, worst .057 and .040.
TEST(Buildings, LinesWithCalibrationPriorAndLoopClosure) {
  LIBSLAM_REQUIRE_DATA(data, "carmen");
  for (const char* name : {"aces", "intel"}) {
    const TemporaryDirectory scratch;
    const LogRun run = map_building(data, name, "buildings.yaml", scratch.path());
    EXPECT_LE(smoothed(run).trans_mean_m, 0.08) << name;
    EXPECT_LE(smoothed(run).rot_mean_deg, 1.5) << name;
    EXPECT_EQ(smoothed(run).unmatched, 0) << name;
  }
}

// The Intel robot turns by 3 degrees per metre driven. Who does not know loses the building.
TEST(Buildings, IntelNeedsItsOdometryCalibrated) {
  LIBSLAM_REQUIRE_DATA(data, "carmen");
  const TemporaryDirectory scratch;
  auto settings = kNoLoops;
  const LogRun with = map_building(data, "intel", "buildings.yaml", scratch.path(), settings);
  EXPECT_NEAR(with.calibration("bias_turn").mean, 0.059, 0.004);
  for (const char* name : {"bias_turn", "scale_turn", "scale_speed"})
    settings.push_back("calibration." + std::string(name) + ".enabled=false");
  const LogRun without = map_building(data, "intel", "buildings.yaml", scratch.path(), settings);
  EXPECT_GT(smoothed(without).trans_mean_m, 5.0 * smoothed(with).trans_mean_m);
}

// Published graph optimization: .044 m. Measured over five distances: .040 m, worst .043.
TEST(Buildings, MatchedIncrementsAreBetterStill) {
  LIBSLAM_REQUIRE_DATA(data, "carmen");
  const TemporaryDirectory scratch;
  const LogRun run = map_building(data, "aces", "buildings_matched.yaml", scratch.path());
  EXPECT_LE(smoothed(run).trans_mean_m, 0.055);
  EXPECT_LE(smoothed(run).rot_mean_deg, 0.6);
}
