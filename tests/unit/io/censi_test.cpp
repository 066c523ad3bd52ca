#include <mrpt/obs/CObservationOdometry.h>

#include <libslam/io/importers/censi.hpp>
#include <libslam/io/input_error.hpp>

#include "data_directory.hpp"
#include "import_round_trip.hpp"

namespace libslam {
namespace {

using namespace libslam::test;
using mrpt::obs::CObservationOdometry;

const char* const kResults =
    R"({"axle": 0.088, "l_diam": 0.0414, "r_diam": 0.0418, "l_x": -0.003, "l_y": 0.006,
        "l_theta": -1.55, "covariance": [[4e-8,0,0,0,0,0],[0,9e-8,0,0,0,0],[0,0,1e-6,0,0,0],
        [0,0,0,1e-6,0,0],[0,0,0,0,4e-6,0],[0,0,0,0,0,1e-4]]})";

class CensiImporter : public ImportTest {
 protected:
  std::string data(const std::string& tuples, const std::string& results = kResults) {
    directory_.write("set/csv/x.csv", tuples);
    directory_.write("set/results/x_results.json", results);
    return (directory_.path() / "set").string();
  }
  static CensiOptions options() {
    CensiOptions options;
    options.subset = "x";
    options.nominal_radius = 0.02;
    options.nominal_track = 0.1;
    return options;
  }
  std::string rejection(const std::string& tuples, const std::string& results = kResults) {
    try {
      import_censi(data(tuples, results), options());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

const char* const kTuples =
    "# T_s,phi_l_rad_s,phi_r_rad_s,sm_x_m,sm_y_m,sm_theta_rad\n"
    "0.5,1,1,0.01,0.001,0.02\n"
    "1.0,-0.5,1.5,-0.002,0.003,3.0\n"
    "1.0,-0.5,1.5,-0.002,0.003,3.0\n";

TEST_F(CensiImporter, NominalOdometryPathOfTheSensorAndPublishedResultReachTheRawlog) {
  ASSERT_TRUE(write_imported_log(import_censi(data(kTuples), options()), rawlog()));
  PlayerOptions player_options = with_policy("strict");
  player_options.input.sensor_label = "scan_matching";
  RawlogPlayer player(rawlog(), player_options);
  const auto steps = play(player);
  ASSERT_EQ(steps.size(), 4u);
  EXPECT_EQ(motion_of(steps[0]), nullptr);
  const auto reading = [&](std::size_t i) {
    return steps[i].frame->getObservationByClass<CObservationOdometry>()->odometry;
  };
  EXPECT_DOUBLE_EQ(steps[2].dt, 1.0);
  const auto increment = motion_of(steps[1])->rawOdometryIncrementReading;
  EXPECT_DOUBLE_EQ(increment.x(), 0.01);  // 0.5 s * 1 rad/s * 0.02 m
  EXPECT_DOUBLE_EQ(increment.phi(), 0.0);
  const auto turn = motion_of(steps[2])->rawOdometryIncrementReading;
  EXPECT_NEAR(turn.phi(), 0.4, 1e-12);  // 2 rad/s * 0.02 m / 0.1 m
  const auto moved = reading(3) - reading(2);
  EXPECT_NEAR(moved.x(), -0.002, 1e-12);
  EXPECT_NEAR(moved.y(), 0.003, 1e-12);
  EXPECT_NEAR(moved.phi(), 3.0, 1e-12);

  const GroundTruth truth = read_truth(find_truth(rawlog()));
  EXPECT_DOUBLE_EQ(truth.calibration.at("scale_left"), 0.0207 / 0.02);
  EXPECT_DOUBLE_EQ(truth.calibration.at("track_width"), 0.88);
  EXPECT_DOUBLE_EQ(truth.calibration.at("sensor_phi"), -1.55);
}

TEST_F(CensiImporter, PublishedSigmasAreInTheUnitsOfTheParameters) {
  const ImportedLog log = import_censi(data(kTuples), options());
  EXPECT_NEAR(log.parameters.at("published_sigma_scale_left"), 2e-4 / 0.02, 1e-12);
  EXPECT_NEAR(log.parameters.at("published_sigma_scale_right"), 3e-4 / 0.02, 1e-12);
  EXPECT_NEAR(log.parameters.at("published_sigma_track_width"), 1e-3 / 0.1, 1e-12);
  EXPECT_NEAR(log.parameters.at("published_sigma_sensor_y"), 2e-3, 1e-12);
}

TEST_F(CensiImporter, OdometryIsUncertainWhereTheWheelsChangeTheirSpeed) {
  const ImportedLog log = import_censi(data(kTuples), options());
  // Left wheel: -0.5 after 1 rad/s, 0.1 s of the difference; right: 0.5 from 1; both 50 um.
  const double left = 0.02 * 0.1 * 1.5, right = 0.02 * 0.1 * 0.5, step = 5e-5;
  const double variance = (left * left + right * right + 2 * step * step) / (0.1 * 0.1);
  EXPECT_NEAR((*log.odometry[2].cov_increment)(2, 2), variance, 1e-12);
  EXPECT_LT((*log.odometry[3].cov_increment - log.odometry[3].cov_increment->transpose()).norm(),
            1e-15);
}

TEST_F(CensiImporter, PlayerGivesTheSensorPathOnlyToWhoNamesIt) {
  ASSERT_TRUE(write_imported_log(import_censi(data(kTuples), options()), rawlog()));
  RawlogPlayer player(rawlog(), with_policy("strict"));
  for (const LogStep& step : play(player)) EXPECT_EQ(step.frame->size(), 0u);
}

TEST_F(CensiImporter, NamesFileAndLineOfWhatItRejects) {
  EXPECT_NE(rejection("0,1,1,0,0,0\n").find("x.csv:1"), std::string::npos);
  EXPECT_NE(rejection("0.5,1,1,0,0,0\n-1,1,1,0,0,0\n").find("x.csv:2"), std::string::npos);
  EXPECT_NE(rejection("0.5,nan,1,0,0,0\n").find("x.csv:1"), std::string::npos);
  EXPECT_NE(rejection("0.5,1e9,1,0,0,0\n").find("100 rad/s"), std::string::npos);
  EXPECT_NE(rejection("0.5,1,1,0\n").find("x.csv:1"), std::string::npos);
  EXPECT_NE(rejection("# nothing\n").find("holds no tuples"), std::string::npos);
  EXPECT_NE(rejection(kTuples, "{}").find("x_results.json"), std::string::npos);
  EXPECT_NE(rejection(kTuples, "[1,").find("x_results.json"), std::string::npos);
  CensiOptions absent = options();
  absent.subset = "y";
  EXPECT_THROW(import_censi(data(kTuples), absent), InputError);
}

TEST_F(CensiImporter, DataSetHasTheDocumentedSize) {
  const std::string directory = data_set("censi_odometry_calibration");
  if (directory.empty()) GTEST_SKIP() << "data set censi_odometry_calibration is not there";
  for (const auto& [subset, tuples] :
       {std::pair("lstraight", 4396), std::pair("l90", 3295), std::pair("lmov", 4345)}) {
    CensiOptions whole;
    whole.subset = subset;
    const ImportedLog log = import_censi(directory, whole);
    EXPECT_EQ(log.sensor_path.size(), static_cast<std::size_t>(tuples) + 1);
    EXPECT_NEAR(log.truth.calibration.at("scale_left"), 0.9, 0.02);
    EXPECT_NEAR(log.truth.calibration.at("track_width"), 1.105, 0.02);
  }
}

}  // namespace
}  // namespace libslam
