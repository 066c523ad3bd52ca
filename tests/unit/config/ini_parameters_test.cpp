#include <filesystem>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>

#include <libslam/config/ini_loader.hpp>
#include <libslam/config/ini_parameters.hpp>
#include <libslam/config/parameter_table.hpp>
#include <libslam/config/validation.hpp>

#include "support/config_error_message.hpp"
#include "support/temporary_directory.hpp"

namespace libslam {
namespace {

Parameters load(const std::string& text) {
  Parameters parameters;
  load_parameters(mrpt::config::CConfigFileMemory(text), parameters);
  return parameters;
}

std::string message(const std::string& text) {
  return test::config_error_message([&] { load(text); });
}

// Every parameter that --help-config lists can be set by its section.
TEST(IniParameters, ReachTheWholeTable) {
  for (const ParameterEntry& entry : list_parameters(Parameters{})) {
    std::ostringstream text;
    text << "[libslam." << entry.section() << "]\n" << entry.key() << " = " << entry.value << '\n';
    EXPECT_NO_THROW(load(text.str())) << entry.name;
  }
}

TEST(IniParameters, HaveShortNames) {
  const Parameters p = load(
      "[calibration.scale_left]\nenabled = true // of the left wheel\nprior_sigma = 0.2\n"
      "[calibration]\nscale_right.enabled = true\n"
      "[adaptation]\n[disturbance]\n"
      "[calibrations]\nof = another program\n[other]\nkey = value\n");
  EXPECT_TRUE(p.calibration.scale_left.enabled);
  EXPECT_EQ(p.calibration.scale_left.prior_sigma, 0.2);
  EXPECT_TRUE(p.calibration.scale_right.enabled);
}

TEST(IniParameters, BadOnesAreNamed) {
  EXPECT_EQ(message("[calibration.scale_left]\nenabled = perhaps\n")
                .find("[calibration.scale_left] enabled: "),
            0U);
  EXPECT_NE(message("[adaptation]\nmethd = residual\n").find("policies.noise_adaptation.methd"),
            std::string::npos);
  EXPECT_NE(message("[disturbance]\nrespnse = none\n").find("policies.disturbance.respnse"),
            std::string::npos);
  EXPECT_EQ(message("[calibration]\nscale_left.enabled = true\n"
                    "[libslam.calibration.scale_left]\nenabled = true\n"),
            "[libslam.calibration.scale_left] enabled: is set under another name as well");
}

TEST(IniParameters, AreWrittenAsTheyAreRead) {
  Parameters p;
  p.motion.track_width = 0.4;
  p.calibration.scale_left.enabled = true;
  std::ostringstream dump;
  dump_parameters(dump, p);
  EXPECT_NE(dump.str().find("libslam.motion.track_width = 0.4\n"), std::string::npos);
  EXPECT_NE(dump.str().find("libslam.calibration.scale_left.enabled = true\n"), std::string::npos);
}

TEST(KfSlamIniWithAdditions, IsReadLikeByTheModule) {
  const test::TemporaryDirectory directory;
  const auto file = directory.write("slam.ini",
                                    "[RangeBearingKFSLAM]\nstd_sensor_range = 0.2\n"
                                    "[libslam.motion]\nmodel = differential\n"
                                    "[calibration.scale_left]\nenabled = true\n");
  const KfSlamIni ini = load_kf_slam_ini(file);
  EXPECT_EQ(ini.parameters.motion.model, "differential");
  EXPECT_TRUE(ini.parameters.calibration.scale_left.enabled);
  EXPECT_EQ(ini.parameters.measurement.sigma_range, 0.2);
  for (const std::string& note : ini.notes)
    EXPECT_EQ(note.find("calibration"), std::string::npos) << note;
  const auto bad = directory.write("bad.ini",
                                   "[RangeBearingKFSLAM]\nstd_sensor_range = 0.2\n"
                                   "[libslam.measurement]\nsigma_range = 0.1\n");
  EXPECT_EQ(test::config_error_message([&] { load_kf_slam_ini(bad); }),
            bad.string() +
                ": [libslam.measurement] sigma_range: is MRPT's option "
                "std_sensor_range; set it in [RangeBearingKFSLAM]");
}

TEST(ShippedIniFiles, LoadAndAreSound) {
  const std::filesystem::path file =
      std::filesystem::path(LIBSLAM_SOURCE_DIR) / "config/mrpt_adaptive.ini";
  const KfSlamIni ini = load_kf_slam_ini(file);
  EXPECT_NO_THROW(validate(ini.parameters));
  EXPECT_TRUE(ini.parameters.calibration.scale_right.enabled);
}

}  // namespace
}  // namespace libslam
