// UTIAS Starry Night: a real stereo camera in space, 20 surveyed markers, Vicon truth. The errors
// of its pixels are common to all of a frame (correlation of left and right .9, from frame to frame
// .8), so consistency is no bar here where the map is known.

#include <cmath>
#include <map>
#include <string>
#include <tests/golden/spatial_run.hpp>
#include <utility>

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

namespace {

/// The sigmas of the configuration, multiplied; adapted from there on.
std::vector<std::string> adapted_from(double factor) {
  std::vector<std::string> settings = {"policies.noise_adaptation.method=residual",
                                       "policies.noise_adaptation.forgetting=0.99"};
  for (const auto& [name, sigma] : {std::pair("u_left", 6.16279), std::pair("v_left", 11.3945),
                                    std::pair("u_right", 6.47709), std::pair("v_right", 11.5104)})
    settings.push_back(std::string("measurement.stereo.sigma_") + name + "=" +
                       std::to_string(factor * sigma));
  return settings;
}

}  // namespace

TEST_F(StarryNight, LocalizesWithNoiseThatIsAdaptedFromNineTimesTheVariance) {
  LIBSLAM_REQUIRE_DATA(data, "utias_starry_night");
  const SpatialLog log = import_starry_night(data);
  write_spatial_log(log, directory().string() + ".rawlog");
  run_spatial(kConfig, log, directory(), in_the_map(adapted_from(3.0)));
  const PathErrors window = errors_of_steps(directory(), kFirst, kLast);
  EXPECT_LE(window.raw->rmse_m, 0.034);
  EXPECT_LE(degrees(window.rotation->rmse_rad), 3.1);
}

// Real pixels have errors in common, for which small sigmas are right. On white ones the adapted
// sigmas must be those of the simulation, from either side, and the pose as good from the start.
TEST_F(StarryNight, AdaptsToWhitePixels) {
  LIBSLAM_REQUIRE_DATA(data, "utias_starry_night");
  SpatialLog log = import_starry_night(data);
  const Eigen::Vector4d sigma = starry_night_sigma(log), variance = sigma.cwiseAbs2();
  simulate_pixels(log, sigma, 1);
  const std::map<std::string, double> true_sigma = {
      {"u", sigma[0]},
      {"v", std::sqrt(variance[1] * variance[3] / (variance[1] + variance[3]))},
      {"d", std::sqrt(variance[0] + variance[2])}};
  write_spatial_log(log, directory().string() + ".rawlog");
  const LogRun right = run_spatial(kConfig, log, directory(), in_the_map());
  const double rmse = right.summary.truth->path->raw->rmse_m;
  const double nees = right.summary.truth->nees->mean;
  for (const double factor : {3.0, 1.0 / 3.0}) {
    const LogRun run = run_spatial(kConfig, log, directory(), in_the_map(adapted_from(factor)));
    ASSERT_EQ(run.summary.result.noise.size(), true_sigma.size());
    for (const AdaptedNoise& noise : run.summary.result.noise)
      EXPECT_NEAR(noise.sigma / true_sigma.at(noise.name), 1.0, 0.05) << noise.name;
    EXPECT_LE(run.summary.truth->path->raw->rmse_m, 1.08 * rmse) << factor;  // .99, 1.01
    EXPECT_LE(run.summary.truth->nees->mean, 1.4 * nees) << factor;          // .81, 1.10
  }
}
