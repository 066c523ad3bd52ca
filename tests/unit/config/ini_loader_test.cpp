#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include <libslam/config/ini_loader.hpp>
#include <libslam/config/validation.hpp>

#include "support/config_error_message.hpp"
#include "support/temporary_directory.hpp"

namespace libslam {
namespace {

const std::filesystem::path kStock = "/usr/share/mrpt/config_files/kf-slam";
const std::filesystem::path kDatasets = "/usr/share/mrpt/datasets";

bool has_note(const KfSlamIni& ini, const std::string& key) {
  return std::ranges::any_of(ini.notes,
                             [&](const std::string& note) { return note.starts_with(key + ": "); });
}

TEST(KfSlamIni, EveryStockFileLoadsAndIsSound) {
  int files = 0;
  for (const auto& file : std::filesystem::directory_iterator(kStock)) {
    SCOPED_TRACE(file.path().string());
    const KfSlamIni ini = load_kf_slam_ini(file.path());
    EXPECT_TRUE(find_conflicts(ini.parameters).empty());
    for (const std::string& note : ini.notes) {
      EXPECT_TRUE(note.ends_with('.')) << note;
      EXPECT_EQ(note.find("has no counterpart"), std::string::npos) << note;
    }
    ++files;
  }
  EXPECT_EQ(files, 7);
}

TEST(KfSlamIni, PlanarDemo) {
  const KfSlamIni ini = load_kf_slam_ini(kStock / "EKF-SLAM_test_2d.ini");
  const Parameters& p = ini.parameters;
  EXPECT_EQ(p.measurement.sigma_range, 0.03);
  EXPECT_EQ(p.measurement.sigma_bearing_deg, 0.1);
  EXPECT_EQ(p.measurement.noise, "configured");
  EXPECT_EQ(p.filter.error_frame, "standard");
  EXPECT_EQ(p.motion.model, "odometry_increment");
  EXPECT_EQ(p.motion.increment_form, "composition");
  EXPECT_TRUE(p.motion.noise.from_log);
  EXPECT_EQ(p.association.method, "known_or_nearest");
  EXPECT_EQ(p.association.gate_probability, 0.99);
  EXPECT_EQ(p.association.new_landmark_probability, 0.99);
  EXPECT_EQ(ini.log_output_dir, "LOG_EKF-SLAM");
  EXPECT_FALSE(ini.rawlog_file);
  EXPECT_FALSE(ini.ground_truth_file);
  EXPECT_FALSE(ini.ground_truth_file_robot);
  EXPECT_FALSE(has_note(ini, "kf_implementation"));
  EXPECT_EQ(p.input.odometry, "auto");
  EXPECT_EQ(p.motion.no_odometry_sigma_xy, 0.1);
  EXPECT_EQ(p.motion.no_odometry_sigma_heading_deg, 2.0);
  EXPECT_TRUE(has_note(ini, "SHOW_3D_LIVE"));
}

TEST(KfSlamIni, FindsFilesFromTheFolderOfTheIniFile) {
  const KfSlamIni ini = load_kf_slam_ini(kStock / "EKF-SLAM_test.ini");
  EXPECT_EQ(ini.rawlog_file, (kDatasets / "kf-slam_demo.rawlog").string());
  EXPECT_EQ(ini.ground_truth_file, (kDatasets / "kf-slam_demo_ground_truth.txt").string());
  EXPECT_EQ(ini.ground_truth_file_robot,
            (kDatasets / "kf-slam_demo_ground_truth_robot_path.txt").string());
  EXPECT_TRUE(has_note(ini, "kf_implementation"));
  EXPECT_EQ(ini.parameters.input.odometry, "none");
}

TEST(KfSlamIni, NoiseWithoutOdometryInItsLaterForm) {
  const test::TemporaryDirectory directory;
  const KfSlamIni planar = load_kf_slam_ini(
      directory.write("a.ini", "[RangeBearingKFSLAM]\nstds_Q_no_odo=[0.2 0.2 3]\n"));
  EXPECT_EQ(planar.parameters.motion.no_odometry_sigma_xy, 0.2);
  EXPECT_EQ(planar.parameters.motion.no_odometry_sigma_heading_deg, 3.0);
  EXPECT_FALSE(has_note(planar, "stds_Q_no_odo"));
  const KfSlamIni spatial = load_kf_slam_ini(directory.write(
      "b.ini", "[RangeBearingKFSLAM]\nstds_Q_no_odo=[0.2 0.2 0.2 0.1 0.1 0.1 0.1]\n"));
  EXPECT_EQ(spatial.parameters.motion.no_odometry_sigma_xy, 0.1);
  EXPECT_TRUE(has_note(spatial, "stds_Q_no_odo"));
}

TEST(KfSlamIni, JointCompatibilityIsFollowedAndMetricsAreNoted) {
  const KfSlamIni ini = load_kf_slam_ini(kStock / "EKF-SLAM_6D_test_datassoc.ini");
  EXPECT_EQ(ini.parameters.association.method, "known_or_joint");
  EXPECT_FALSE(has_note(ini, "data_assoc_method"));
  EXPECT_TRUE(has_note(ini, "data_assoc_metric"));
  EXPECT_FALSE(has_note(ini, "data_assoc_IC_metric"));
  EXPECT_TRUE(has_note(ini, "std_sensor_pitch_deg"));
}

TEST(KfSlamIni, NothingIsDroppedInSilence) {
  const test::TemporaryDirectory directory;
  const KfSlamIni ini = load_kf_slam_ini(directory.write(
      "a.ini",
      "[MappingApplication]\nkf_implementation=CRangeBearingKFSLAM2D\nrawlog_file=no.rawlog\n"
      "ground_truth_file=no.txt\nrawlog_offset=7\n[RangeBearingKFSLAM]\nmy_own_key=3\n"
      "data_assoc_method=1\ndata_assoc_IC_metric=metricML\nforce_ignore_odometry=0\n"
      "[RangeBearingKFSLAM_KalmanFilter]\nmethod=kfIKFFull\n[Elsewhere]\nkey=1\n"));
  EXPECT_EQ(ini.rawlog_file, "no.rawlog");
  EXPECT_FALSE(ini.ground_truth_file);
  for (const char* key : {"ground_truth_file", "rawlog_offset", "[RangeBearingKFSLAM] 'my_own_key'",
                          "data_assoc_IC_metric", "method", "[Elsewhere] 'key'"}) {
    EXPECT_TRUE(has_note(ini, key)) << key;
  }
  EXPECT_EQ(ini.notes.size(), 6U);
}

TEST(KfSlamIni, DefaultsAreThoseOfMrpt) {
  const test::TemporaryDirectory directory;
  const KfSlamIni ini = load_kf_slam_ini(directory.write("a.ini", "[RangeBearingKFSLAM]\n"));
  EXPECT_EQ(ini.parameters.measurement.sigma_range, 0.1);
  EXPECT_EQ(ini.parameters.measurement.sigma_bearing_deg, 0.5);
  EXPECT_EQ(ini.log_output_dir, "");
}

struct BadIni {
  const char* text;
  const char* message;  ///< what follows the file name
};

class KfSlamIniRejects : public testing::TestWithParam<BadIni> {};

TEST_P(KfSlamIniRejects, WithLineAndReason) {
  const test::TemporaryDirectory directory;
  const std::filesystem::path file = directory.write("bad.ini", GetParam().text);
  EXPECT_EQ(test::config_error_message([&] { load_kf_slam_ini(file); }),
            file.string() + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Values, KfSlamIniRejects,
    testing::Values(
        BadIni{"[Motion]\nmodel=a\n",
               ": is no kf-slam ini file, section [RangeBearingKFSLAM] is expected"},
        BadIni{
            "\n[RangeBearingKFSLAM]\nstd_sensor_range = wide // m\n",
            ":3: [RangeBearingKFSLAM] std_sensor_range: measurement.sigma_range: 'wide' is not a "
            "finite number >= 1e-09 [m]"},
        BadIni{
            "[RangeBearingKFSLAM]\nstd_sensor_yaw_deg=-1\n",
            ":2: [RangeBearingKFSLAM] std_sensor_yaw_deg: measurement.sigma_bearing_deg: '-1' is "
            "not a finite number >= 1e-09 [deg]"},
        BadIni{"[RangeBearingKFSLAM]\ndata_assoc_method = assocJCB\n",
               ":2: [RangeBearingKFSLAM] data_assoc_method: 'assocJCB' is unknown; nearest: "
               "assocJCBB"},
        BadIni{"[RangeBearingKFSLAM]\n[MappingApplication]\nkf_implementation = EKF\n",
               ":3: [MappingApplication] kf_implementation: 'EKF' is unknown; nearest: "
               "CRangeBearingKFSLAM"},
        BadIni{"[RangeBearingKFSLAM]\nforce_ignore_odometry = maybe\n",
               ":2: [RangeBearingKFSLAM] force_ignore_odometry: 'maybe' is not true or false"},
        BadIni{"[RangeBearingKFSLAM]\nstd_sensor_range=1\nstd_sensor_range=x\n",
               ":3: [RangeBearingKFSLAM] std_sensor_range: measurement.sigma_range: 'x' is not a "
               "finite number >= 1e-09 [m]"},
        BadIni{"[RangeBearingKFSLAM]\ndata_assoc_IC_chi2_thres=9.2\n",
               ":2: [RangeBearingKFSLAM] data_assoc_IC_chi2_thres: association.gate_probability: "
               "'9.2' is not a finite number >= 0 and <= 1"}));

}  // namespace
}  // namespace libslam
