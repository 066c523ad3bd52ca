// UTIAS Starry Night: a real stereo camera in space, 20 surveyed markers, Vicon truth. The errors
// of its pixels are common to all of a frame (correlation of left and right .9, from frame to frame
// .8), so consistency is no bar here where the map is known.

#include <tests/golden/spatial_run.hpp>

#include <libslam/io/importers/starry_night.hpp>

using namespace libslam;
using namespace libslam::test;

namespace {

constexpr const char* kConfig = "starry_night.yaml";
/// The part of the log that is evaluated in the literature: rows 1215-1714 of the data set, from 1.
constexpr std::int64_t kFirst = 1214, kLast = 1713;

class StarryNight : public testing::Test {
 protected:
  std::filesystem::path directory() const { return scratch_.path() / "run"; }
  std::vector<std::string> in_the_map(std::vector<std::string> settings = {}) const {
    settings.push_back("map.file=" + directory().string() + ".landmarks.csv");
    return settings;
  }

 private:
  TemporaryDirectory scratch_;
};

const std::vector<std::string> kSlam = {"filter.initial_sigma_xy=0",
                                        "filter.initial_sigma_heading_deg=0"};

}  // namespace

TEST_F(StarryNight, LocalizesInTheSurveyedMarkers) {
  LIBSLAM_REQUIRE_DATA(data, "utias_starry_night");
  const SpatialLog log = import_starry_night(data);
  write_spatial_log(log, directory().string() + ".rawlog");
  const LogRun run = run_spatial(kConfig, log, directory(), in_the_map());
  const PathErrors& all = *run.summary.truth->path;
  EXPECT_EQ(all.poses, 1900);
  EXPECT_LE(all.raw->rmse_m, 0.040);
  EXPECT_LE(degrees(all.rotation->rmse_rad), 3.5);
  const PathErrors window = errors_of_steps(directory(), kFirst, kLast);
  EXPECT_EQ(window.poses, 500);
  EXPECT_LE(window.raw->rmse_m, 0.033);
  EXPECT_LE(degrees(window.rotation->rmse_rad), 3.0);
  EXPECT_EQ(run.summary.exit_code, 0);
}

TEST_F(StarryNight, MapsTheMarkersWithTheInvariantFrameAlone) {
  LIBSLAM_REQUIRE_DATA(data, "utias_starry_night");
  const SpatialLog log = import_starry_night(data);
  const LogRun run = run_spatial(kConfig, log, directory(), kSlam);
  const TruthComparison& truth = *run.summary.truth;
  EXPECT_EQ(truth.map->matched, 20);
  EXPECT_LE(*truth.map->rmse_aligned_m, 0.008);
  EXPECT_LE(*truth.map->rmse_m, 0.070);
  EXPECT_LE(truth.path->aligned->rmse_m, 0.050);
  EXPECT_GE(truth.nees->mean, 3.0);
  EXPECT_LE(truth.nees->mean, 8.0);

  auto settings = kSlam;
  settings.push_back("filter.error_frame=standard");
  const LogRun standard = run_spatial(kConfig, log, directory(), settings);
  EXPECT_LE(truth.nees->mean, 0.25 * standard.summary.truth->nees->mean);
}
