// Khepera III, three mountings of a laser: wheels, track and sensor pose from scan-matched
// displacements in one pass, against the published batch result.

#include <tests/golden/batch_calibration.hpp>
#include <tests/golden/log_run.hpp>

#include <libslam/io/importers/censi.hpp>

using namespace libslam;
using namespace libslam::test;

namespace {

const char* const kConfig = "censi.yaml";
const char* const kData = "censi_odometry_calibration";
const std::vector<std::string> kMountings = {"lstraight", "l90", "lmov"};

std::vector<std::string> subsets_of(const std::string& mounting) {
  return {mounting, mounting + "_0", mounting + "_1", mounting + "_2"};
}

ImportedLog load(const std::string& directory, const std::string& subset) {
  CensiOptions options;
  options.subset = subset;
  return import_censi(directory, options);
}

double published_sigma(const ImportedLog& log, const std::string& name) {
  return log.parameters.at("published_sigma_" + name);
}

std::string setting(const std::string& name, double prior_mean) {
  return "calibration." + name + ".prior_mean=" + std::to_string(prior_mean);
}

/// The configuration as it ships; the laser ahead is the one mounting its drawing is not of.
std::vector<std::string> as_shipped(const std::string& mounting) {
  if (mounting == "lstraight") return {setting("sensor_phi", 0.0)};
  return {};
}

/// Every parameter `factor` of its published value, or its inverse for every other one.
std::vector<std::string> start_beside(const ImportedLog& log, double factor) {
  std::vector<std::string> settings;
  for (const auto& [name, value] : log.truth.calibration) {
    settings.push_back(setting(name, factor * value));
    factor = 1.0 / factor;
  }
  return settings;
}

void expect_published(const LogRun& run, const ImportedLog& log) {
  ASSERT_EQ(run.summary.exit_code, 0);
  EXPECT_TRUE(run.summary.input.warnings.empty());
  ASSERT_EQ(run.summary.result.calibration.size(), 6u);
  for (const auto& [name, value] : log.truth.calibration) {
    const CalibrationValue& found = run.calibration(name);
    EXPECT_TRUE(found.observable) << name;
    EXPECT_LE(std::abs(found.mean - value), 3.0 * published_sigma(log, name)) << name;
    // The published sigma of l90 and lmov is too large (last test), so this is the sharper bound: 4
    // sigma of the filter, for 72 correlated estimates from three starts.
    EXPECT_LE(std::abs(found.mean - value), 4.0 * found.sigma) << name;
  }
}

}  // namespace

class Censi : public testing::TestWithParam<std::string> {};

TEST_P(Censi, OnePassFindsThePublishedCalibrationFromTenPercentOff) {
  LIBSLAM_REQUIRE_DATA(directory, kData);
  for (const std::string& subset : subsets_of(GetParam())) {
    SCOPED_TRACE(subset);
    const TemporaryDirectory scratch;
    const ImportedLog log = load(directory, subset);
    expect_published(run_imported(kConfig, log, scratch.path() / "run", as_shipped(GetParam())),
                     log);
    for (const double factor : {0.9, 1.1})
      expect_published(
          run_imported(kConfig, log, scratch.path() / "beside", start_beside(log, factor)), log);
  }
}

// A batch fit with the spread of its own residuals, failed scan matches trimmed, is the yardstick:
// the published covariances of l90 and lmov are 5 to 17 times too large (last test), as if failed
// matches had been left in the noise they were computed with.
TEST_P(Censi, UncertaintyIsThatOfABatchFit) {
  LIBSLAM_REQUIRE_DATA(directory, kData);
  for (const std::string& subset : subsets_of(GetParam())) {
    SCOPED_TRACE(subset);
    const TemporaryDirectory scratch;
    const ImportedLog log = load(directory, subset);
    const LogRun run = run_imported(kConfig, log, scratch.path() / "run", as_shipped(GetParam()));
    const BatchCalibration batch =
        fit_calibration(log, log.parameters.at("nominal_track"), log.truth.calibration);
    EXPECT_GT(batch.trimmed, 0.005);
    EXPECT_LT(batch.trimmed, 0.10);
    for (const auto& [name, value] : log.truth.calibration) {
      const CalibrationValue& found = run.calibration(name);
      EXPECT_LE(std::abs(batch.mean.at(name) - value), published_sigma(log, name) * 2.0) << name;
      EXPECT_GE(found.sigma, 0.5 * batch.sigma.at(name)) << name;
      EXPECT_LE(found.sigma, 2.0 * batch.sigma.at(name)) << name;
      if (GetParam() != "lstraight") continue;
      EXPECT_GE(found.sigma, 0.5 * published_sigma(log, name)) << name;
      EXPECT_LE(found.sigma, 2.0 * published_sigma(log, name)) << name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Mountings, Censi, testing::ValuesIn(kMountings),
                         [](const auto& mounting) { return mounting.param; });

// Three disjoint thirds of one recording: the spread of their published results is a sample of
// their published sigma, and the sum of squares a chi-square of 2 for every parameter. Below 0.04
// has a probability of 2 %; all of four parameters are far below for l90 and lmov (.001 to .03),
// none for lstraight (1.2 to 2.1).
TEST(CensiData, PublishedSigmaOfTurnedMountingsIsTooLarge) {
  LIBSLAM_REQUIRE_DATA(directory, kData);
  const auto spread = [&](const std::string& mounting, const std::string& name) {
    double mean = 0.0, sum = 0.0;
    std::vector<double> values, sigmas;
    for (const char* third : {"_0", "_1", "_2"}) {
      const ImportedLog log = load(directory, mounting + third);
      values.push_back(log.truth.calibration.at(name));
      sigmas.push_back(published_sigma(log, name));
      mean += values.back() / 3.0;
    }
    for (std::size_t i = 0; i < 3; ++i) sum += std::pow((values[i] - mean) / sigmas[i], 2);
    return sum;
  };
  for (const char* name : {"track_width", "sensor_x", "sensor_y", "sensor_phi"}) {
    EXPECT_LT(spread("l90", name), 0.04) << name;
    EXPECT_LT(spread("lmov", name), 0.04) << name;
    EXPECT_GT(spread("lstraight", name), 0.5) << name;
  }
}
