#include <algorithm>
#include <array>
#include <string_view>

#include <mrpt/system/string_utils.h>

#include <libslam/config/ini_parameters.hpp>
#include <libslam/config/kf_slam_remarks.hpp>
#include <libslam/config/text_file.hpp>

namespace libslam {
namespace {

/// A key whose fate is known.
struct Remark {
  const char* key;
  const char* sentence;      ///< nullptr: the loader follows the key
  bool only_if_set = false;  ///< nothing to say of 0 and false
};

constexpr const char* kPlanar = "has no meaning for the planar filter.";
constexpr const char* kRunDirectory =
    "the run directory always holds path, map and the files for MRPT's tools.";
constexpr const char* kDisplay = "concerns the live view only.";
constexpr const char* kVerbose = "--verbose and --quiet choose what is printed.";
constexpr const char* kAnalytic = "Jacobians are analytic and checked by the tests.";
constexpr const char* kPartition = "the partitioning experiment is not available.";

constexpr auto kRemarks = std::to_array<Remark>({
    // [MappingApplication]
    {"rawlog_file", nullptr},
    {"ground_truth_file", nullptr},
    {"ground_truth_file_robot", nullptr},
    {"logOutput_dir", nullptr},
    {"kf_implementation", nullptr},
    {"rawlog_offset", "the log is read from its beginning.", true},
    {"ground_truth_data_association", "true associations are not evaluated.", true},
    {"SAVE_LOG_FREQUENCY", "every step is written to trajectory.csv."},
    {"SAVE_DA_LOG", kRunDirectory},
    {"SAVE_3D_SCENES", kRunDirectory},
    {"SAVE_MAP_REPRESENTATIONS", kRunDirectory},
    {"SHOW_3D_LIVE", "there is no live view; report.html shows the run.", true},
    {"CAMERA_3DSCENE_FOLLOWS_ROBOT", kDisplay, true},
    // [RangeBearingKFSLAM_KalmanFilter]
    {"method", nullptr},
    {"verbose", kVerbose, true},
    {"verbosity_level", kVerbose},
    {"IKF_iterations", "the iterated filter is not available."},
    {"enable_profiler", "run.json holds the times of every phase.", true},
    {"use_analytic_transition_jacobian", kAnalytic},
    {"use_analytic_observation_jacobian", kAnalytic},
    {"debug_verify_analytic_jacobians", kAnalytic, true},
    {"debug_verify_analytic_jacobians_threshold", kAnalytic},
    // [RangeBearingKFSLAM]
    {"std_sensor_range", nullptr},
    {"std_sensor_yaw_deg", nullptr},
    {"data_assoc_method", nullptr},
    {"data_assoc_metric", nullptr},
    {"data_assoc_IC_chi2_thres", nullptr},
    {"data_assoc_IC_metric", nullptr},
    {"data_assoc_IC_ml_threshold", "there is no gate by matching likelihood.", true},
    {"std_sensor_pitch_deg", kPlanar},
    {"std_odo_z_additional", kPlanar, true},
    {"stdXY_no_odo", nullptr},
    {"stdPhi_no_odo_deg", nullptr},
    {"stds_Q_no_odo", nullptr},
    {"force_ignore_odometry", nullptr},
    {"create_simplemap", kRunDirectory},
    {"quantiles_3D_representation", kDisplay},
    {"doPartitioningExperiment", kPartition, true},
    {"partitionThreshold", kPartition},
    {"partitioningMethod", kPartition},
});

bool is_unset(const std::string& value) {
  return value.empty() || value == "0" || value == "0.0" || mrpt::system::strCmpI(value, "false") ||
         mrpt::system::strCmpI(value, "no");
}

}  // namespace

void append_remarks(const mrpt::config::CConfigFileBase& ini, std::vector<std::string>& notes) {
  std::vector<std::string> sections;
  ini.getAllSections(sections);
  for (const std::string& section : sections) {
    if (is_parameter_section(section)) continue;
    std::vector<std::string> keys;
    ini.getAllKeys(section, keys);
    for (const std::string& key : keys) {
      const auto remark = std::ranges::find_if(
          kRemarks, [&](const Remark& r) { return mrpt::system::strCmpI(r.key, key); });
      if (remark == kRemarks.end()) {
        notes.push_back("[" + section + "] " + quote_for_message(key) +
                        ": has no counterpart and is ignored.");
        continue;
      }
      const std::string value = mrpt::system::trim(ini.read_string(section, key, ""));
      if (remark->sentence != nullptr && !(remark->only_if_set && is_unset(value))) {
        notes.push_back(key + ": " + remark->sentence);
      }
    }
  }
}

}  // namespace libslam
