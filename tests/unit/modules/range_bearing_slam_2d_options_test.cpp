#include <cmath>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>

#include <libslam/config/ini_loader.hpp>
#include <libslam/config/parameter_table.hpp>
#include <libslam/data/step_record.hpp>
#include <libslam/io/rawlog_player.hpp>
#include <libslam/modules/range_bearing_slam_2d.hpp>

#include "support/config_error_message.hpp"

namespace libslam {
namespace {

constexpr const char* kIni = "/usr/share/mrpt/config_files/kf-slam/EKF-SLAM_test_2d.ini";

RangeBearingSlam2D::TOptions load(const std::string& text) {
  RangeBearingSlam2D slam;
  slam.loadOptions(mrpt::config::CConfigFileMemory(text));
  return slam.options;
}

TEST(RangeBearingSlam2dOptions, DefaultsAreThoseOfMrpt) {
  const RangeBearingSlam2D::TOptions ours;
  const mrpt::slam::CRangeBearingKFSLAM2D::TOptions stock;
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(ours.stds_Q_no_odo[i], stock.stds_Q_no_odo[i]);
  EXPECT_EQ(ours.std_sensor_range, stock.std_sensor_range);
  EXPECT_EQ(ours.std_sensor_yaw, stock.std_sensor_yaw);
  EXPECT_EQ(ours.quantiles_3D_representation, stock.quantiles_3D_representation);
  EXPECT_EQ(ours.create_simplemap, stock.create_simplemap);
  EXPECT_EQ(ours.data_assoc_method, stock.data_assoc_method);
  EXPECT_EQ(ours.data_assoc_metric, stock.data_assoc_metric);
  EXPECT_EQ(ours.data_assoc_IC_chi2_thres, stock.data_assoc_IC_chi2_thres);
  EXPECT_EQ(ours.data_assoc_IC_metric, stock.data_assoc_IC_metric);
  EXPECT_EQ(ours.data_assoc_IC_ml_threshold, stock.data_assoc_IC_ml_threshold);
}

// slam-run and the module read the same file: all parameters agree, sigmas to single precision.
TEST(RangeBearingSlam2dOptions, StockIniMeansWhatItMeansToSlamRun) {
  RangeBearingSlam2D slam;
  slam.loadOptions(mrpt::config::CConfigFile(kIni));
  const auto ours = list_parameters(slam.options.getEffectiveParameters());
  const auto loader = list_parameters(load_kf_slam_ini(kIni).parameters);
  ASSERT_EQ(ours.size(), loader.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (ours[i].type == ParameterType::kReal) {
      const double expected = std::stod(loader[i].value);
      EXPECT_NEAR(std::stod(ours[i].value), expected, 1e-6 * std::abs(expected)) << ours[i].name;
    } else {
      EXPECT_EQ(ours[i].value, loader[i].value) << ours[i].name;
    }
  }
  EXPECT_EQ(slam.KF_options.method, mrpt::bayes::kfEKFNaive);
}

TEST(RangeBearingSlam2dOptions, TakeMrptEnumeratorsAndNames) {
  RangeBearingSlam2D::TOptions options;
  options.data_assoc_method = mrpt::slam::assocJCBB;
  EXPECT_EQ(options.data_assoc_method, mrpt::slam::assocJCBB);
  const auto loaded = load(
      "[RangeBearingKFSLAM]\ndata_assoc_method = assocJCBB\ndata_assoc_IC_metric = metricML\n"
      "data_assoc_IC_chi2_thres = 0.9\nstds_Q_no_odo = [0.2 0.2 3]\nforce_ignore_odometry = true\n"
      "[RangeBearingKFSLAM_KalmanFilter]\nmethod = kfIKF\n");
  EXPECT_EQ(loaded.data_assoc_method, mrpt::slam::assocJCBB);
  EXPECT_EQ(loaded.data_assoc_IC_metric, mrpt::slam::metricML);
  const Parameters p = loaded.getEffectiveParameters();
  EXPECT_EQ(p.association.gate_probability, 0.9);
  EXPECT_EQ(p.association.new_landmark_probability, 0.9);
  EXPECT_FLOAT_EQ(static_cast<float>(p.motion.no_odometry_sigma_xy), 0.2F);
  EXPECT_FLOAT_EQ(static_cast<float>(p.motion.no_odometry_sigma_heading_deg), 3.0F);
  EXPECT_EQ(p.input.odometry, "none");
}

TEST(RangeBearingSlam2dOptions, SectionsOfLibslamSetTheOtherParameters) {
  const auto options = load(
      "[libslam.filter]\nerror_frame = right_invariant // consistent\n"
      "[libslam.motion]\nmodel = differential\ntrack_width = 0.4\n"
      "[libslam.calibration.scale_left]\nenabled = true\nprior_sigma = 0.05\n"
      "[libslam.association]\nnew_landmark_probability = 0.9999\n");
  const Parameters p = options.getEffectiveParameters();
  EXPECT_EQ(p.filter.error_frame, "right_invariant");
  EXPECT_EQ(p.motion.track_width, 0.4);
  EXPECT_TRUE(p.calibration.scale_left.enabled);
  EXPECT_FALSE(p.calibration.scale_right.enabled);
  EXPECT_EQ(p.calibration.scale_left.prior_sigma, 0.05);
  EXPECT_EQ(p.association.new_landmark_probability, 0.9999);
  std::ostringstream dump;
  options.dumpToTextStream(dump);
  EXPECT_NE(dump.str().find("libslam.calibration.scale_left.enabled = true\n"), std::string::npos);
  EXPECT_NE(dump.str().find("std_sensor_range"), std::string::npos);
  EXPECT_EQ(dump.str().find("libslam.measurement.sigma_range"), std::string::npos);
}

TEST(RangeBearingSlam2dOptions, BadOnesAreNamed) {
  const auto message = [](const std::string& text) {
    return test::config_error_message([&] { load(text).getEffectiveParameters(); });
  };
  EXPECT_EQ(message("[libslam.filter]\nerror_frme = standard\n"),
            "[libslam.filter] error_frme: unknown key 'filter.error_frme'; nearest valid key: "
            "filter.error_frame");
  EXPECT_EQ(message("[libslam.measurement]\nsigma_range = 0.1\n"),
            "[libslam.measurement] sigma_range: is MRPT's option std_sensor_range; set it in "
            "[RangeBearingKFSLAM]");
  EXPECT_EQ(message("[RangeBearingKFSLAM]\nstds_Q_no_odo = 0.1 0.2 3\n"),
            "stds_Q_no_odo: takes x, y, phi with x equal to y");
  EXPECT_EQ(message("[RangeBearingKFSLAM]\nstds_Q_no_odo = 0.1 3\n"),
            "[RangeBearingKFSLAM] stds_Q_no_odo: takes x y phi_deg");
  EXPECT_NE(
      message("[RangeBearingKFSLAM]\nstd_sensor_range = -1\n").find("measurement.sigma_range"),
      std::string::npos);
  // The default motion model has no wheels to calibrate.
  EXPECT_NE(message("[libslam.calibration.scale_left]\nenabled = true\n").find("motion.model"),
            std::string::npos);
}

// The shipped file calibrates and adapts. MRPT's simulator made the demo with sigmas of 1 cm and
// 0.1 degrees (simul_landmarks_demo_EKF-SLAM.ini) and with sound wheels. Of the start, ten times as
// much, .96^250 of the variance is left: nothing. Updates that count like (1 + b) / (1 - b) = 49
// equal ones give sigma within 1 / sqrt(2 * 49), one part in ten, with a single sighting each;
// twice that.
TEST(RangeBearingSlam2dOptions, OfTheShippedFileAdapt) {
  RangeBearingSlam2D slam;
  slam.setMinLoggingLevel(mrpt::system::LVL_ERROR);
  slam.loadOptions(mrpt::config::CConfigFile(LIBSLAM_SOURCE_DIR "/config/mrpt_adaptive.ini"));
  EXPECT_TRUE(slam.getCurrentNoise().empty());  // before the first pair
  RawlogPlayer player("/usr/share/mrpt/datasets/kf-slam_demo.rawlog");
  while (auto step = player.next()) slam.processActionObservation(step->action, step->frame);
  const std::vector<AdaptedNoise> noise = slam.getCurrentNoise();
  ASSERT_EQ(noise.size(), 2U);
  EXPECT_EQ(noise[0].name, "range");
  EXPECT_NEAR(noise[0].configured, 0.1, 1e-6);
  EXPECT_NEAR(noise[0].sigma, 0.01, 0.2 * 0.01);
  EXPECT_NEAR(mrpt::RAD2DEG(noise[1].sigma), 0.1, 0.2 * 0.1);
  const std::vector<CalibrationValue> calibration = slam.getCurrentCalibration();
  ASSERT_EQ(calibration.size(), 2U);
  for (const CalibrationValue& wheel : calibration) EXPECT_NEAR(wheel.mean, 1.0, 0.05);
  EXPECT_EQ(slam.getLastEvent(), "");
}

}  // namespace
}  // namespace libslam
