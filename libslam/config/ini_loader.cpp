#include <algorithm>
#include <exception>
#include <initializer_list>
#include <sstream>
#include <string_view>
#include <system_error>

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/system/string_utils.h>

#include <libslam/config/edit_distance.hpp>
#include <libslam/config/ini_loader.hpp>
#include <libslam/config/ini_parameters.hpp>
#include <libslam/config/kf_slam_remarks.hpp>
#include <libslam/config/parameter_table.hpp>
#include <libslam/config/text_file.hpp>

namespace libslam {
namespace {

constexpr const char* kApplication = "MappingApplication";
constexpr const char* kSlam = "RangeBearingKFSLAM";
constexpr const char* kKalman = "RangeBearingKFSLAM_KalmanFilter";

/// The reason inside an exception of MRPT, which wraps it into a page with a backtrace.
std::string reason_of(const std::exception& error) {
  std::istringstream lines(error.what());
  std::string first, line;
  std::getline(lines, first);
  constexpr std::string_view kMessage = "Message:";
  while (std::getline(lines, line)) {
    if (line.starts_with(kMessage)) {
      return quote_for_message(mrpt::system::trim(line.substr(kMessage.size())));
    }
  }
  return quote_for_message(first);
}

/// An ini file that knows in which line a key stands.
class IniFile {
 public:
  explicit IniFile(const std::filesystem::path& path)
      : file_name_(path.string()), text_(read_config_text(path)) {
    try {
      ini_.setContent(text_);
    } catch (const std::exception& error) {
      throw ConfigError(file_name_ + ": cannot be read as an ini file: " + reason_of(error));
    }
    if (!ini_.sectionExists(kSlam) && !ini_.sectionExists(kApplication)) {
      throw ConfigError(file_name_ + ": is no kf-slam ini file, section [" + kSlam +
                        "] is expected");
    }
  }

  [[noreturn]] void fail(const char* section, const char* key, const std::string& message) const {
    throw ConfigError(file_name_ + line_of(section, key) + ": [" + section + "] " + key + ": " +
                      message);
  }

  /// The whole value; empty if absent.
  std::string text(const char* section, const char* key) const {
    return mrpt::system::trim(ini_.read_string(section, key, ""));
  }

  /// The value up to the first blank; empty if absent.
  std::string word(const char* section, const char* key) const {
    const std::string value = text(section, key);
    return value.substr(0, value.find_first_of(" \t"));
  }

  /// A switch; off if absent.
  bool is_on(const char* section, const char* key) const {
    const std::string value = mrpt::system::lowerCase(word(section, key));
    if (value == "1" || value == "true" || value == "yes") {
      return true;
    }
    if (!value.empty() && value != "0" && value != "false" && value != "no") {
      fail(section, key, quote_for_message(value) + " is not true or false");
    }
    return false;
  }

  /// Copies a value into a parameter, if the file has the key.
  void copy(const char* section, const char* key, const char* name, Parameters& parameters) const {
    if (const std::string value = word(section, key); !value.empty()) {
      assign(section, key, name, value, parameters);
    }
  }

  /// Sets a parameter to `value`, which stands (or is part of what stands) at a key.
  void assign(const char* section, const char* key, const char* name, const std::string& value,
              Parameters& parameters) const {
    try {
      assign_parameter(parameters, name, value);
    } catch (const ConfigError& error) {
      fail(section, key, error.what());
    }
  }

  /// Position of a value among the names of an enumeration; MRPT takes names and numbers.
  std::size_t choice(const char* section, const char* key,
                     std::initializer_list<std::string_view> names, std::size_t if_absent) const {
    const std::string value = word(section, key);
    if (value.empty()) {
      return if_absent;
    }
    std::size_t number = 0;
    for (const std::string_view name : names) {
      if (value == name || value == std::to_string(number)) {
        return number;
      }
      ++number;
    }
    const auto nearest = std::ranges::min_element(
        names, {}, [&](std::string_view name) { return edit_distance(value, name); });
    fail(section, key, quote_for_message(value) + " is unknown; nearest: " + std::string(*nearest));
  }

  const mrpt::config::CConfigFileBase& content() const { return ini_; }

 private:
  /// ":line" of a key, or nothing; of a key given twice the last one counts, as it does for MRPT.
  std::string line_of(const char* section, const char* key) const {
    std::istringstream lines(text_);
    std::string line, current, found;
    for (int number = 1; std::getline(lines, line); ++number) {
      line = mrpt::system::trim(line);
      if (line.starts_with('[')) {
        current = line.substr(1, line.find(']') - 1);
      }
      const bool is_key =
          mrpt::system::strCmpI(mrpt::system::trim(line.substr(0, line.find('='))), key);
      if (is_key && mrpt::system::strCmpI(current, section)) {
        found = std::string(":").append(std::to_string(number));
      }
    }
    return found;
  }

  std::string file_name_, text_;
  mrpt::config::CConfigFileMemory ini_;
};

/// The file that `written` names, or nothing.
std::optional<std::string> locate(const std::filesystem::path& ini_path,
                                  const std::string& written) {
  std::error_code ignored;
  for (const std::filesystem::path& candidate :
       {ini_path.parent_path() / written, std::filesystem::path(written)}) {
    if (std::filesystem::is_regular_file(candidate, ignored)) {
      return candidate.lexically_normal().string();
    }
  }
  return std::nullopt;
}

void read_files(const IniFile& ini, const std::filesystem::path& path, KfSlamIni& result) {
  if (const std::string rawlog = ini.text(kApplication, "rawlog_file"); !rawlog.empty()) {
    result.rawlog_file = locate(path, rawlog).value_or(rawlog);
  }
  for (const auto& [key, field] :
       {std::pair("ground_truth_file", &result.ground_truth_file),
        std::pair("ground_truth_file_robot", &result.ground_truth_file_robot)}) {
    const std::string written = ini.text(kApplication, key);
    if (written.empty()) {
      continue;
    }
    *field = locate(path, written);
    if (!*field) {
      result.notes.push_back(std::string(key) + ": " + written +
                             " does not exist; the run is not compared with it.");
    }
  }
  result.log_output_dir = ini.text(kApplication, "logOutput_dir");
}

void read_filter(const IniFile& ini, KfSlamIni& result) {
  if (ini.choice(kApplication, "kf_implementation",
                 {"CRangeBearingKFSLAM", "CRangeBearingKFSLAM2D"}, 0) == 0) {
    result.notes.emplace_back(
        "kf_implementation: CRangeBearingKFSLAM estimates a pose with six degrees of freedom; here "
        "the planar filter runs.");
  }
  const std::size_t method =
      ini.choice(kKalman, "method", {"kfEKFNaive", "kfEKFAlaDavison", "kfIKFFull", "kfIKF"}, 0);
  if (method == 1) {
    result.notes.emplace_back(
        "method: kfEKFAlaDavison updates one scalar after the other; here one joint update runs.");
  } else if (method > 1) {
    result.notes.emplace_back(
        "method: the iterated filter is not available; here the extended Kalman filter runs.");
  }
  result.parameters.filter.error_frame = "standard";
}

void read_odometry(const IniFile& ini, KfSlamIni& result) {
  Parameters& parameters = result.parameters;
  parameters.motion.model = "odometry_increment";
  parameters.motion.increment_form = "composition";
  parameters.motion.noise.from_log = true;
  if (ini.is_on(kSlam, "force_ignore_odometry")) {
    parameters.input.odometry = "none";
  }
  // The defaults of CRangeBearingKFSLAM2D, where the file is silent.
  parameters.motion.no_odometry_sigma_xy = 0.1;
  parameters.motion.no_odometry_sigma_heading_deg = 4.0;
  ini.copy(kSlam, "stdXY_no_odo", "motion.no_odometry_sigma_xy", parameters);
  ini.copy(kSlam, "stdPhi_no_odo_deg", "motion.no_odometry_sigma_heading_deg", parameters);
  // The later form of the two keys above: x, y, phi_deg (the filter in space has seven numbers).
  std::vector<std::string> sigmas;
  mrpt::system::tokenize(ini.text(kSlam, "stds_Q_no_odo"), "[], \t", sigmas);
  if (sigmas.size() == 3 && sigmas[0] == sigmas[1]) {
    ini.assign(kSlam, "stds_Q_no_odo", "motion.no_odometry_sigma_xy", sigmas[0], parameters);
    ini.assign(kSlam, "stds_Q_no_odo", "motion.no_odometry_sigma_heading_deg", sigmas[2],
               parameters);
  } else if (!sigmas.empty()) {
    result.notes.emplace_back(
        "stds_Q_no_odo: only three numbers x, y, phi with x = y are followed; the noise of steps "
        "without odometry is " +
        std::to_string(parameters.motion.no_odometry_sigma_xy) + " m and " +
        std::to_string(parameters.motion.no_odometry_sigma_heading_deg) + " deg.");
  }
}

void read_sensor(const IniFile& ini, Parameters& parameters) {
  parameters.measurement.noise = "configured";
  // The defaults of CRangeBearingKFSLAM2D, where the file is silent.
  parameters.measurement.sigma_range = 0.1;
  parameters.measurement.sigma_bearing_deg = 0.5;
  ini.copy(kSlam, "std_sensor_range", "measurement.sigma_range", parameters);
  ini.copy(kSlam, "std_sensor_yaw_deg", "measurement.sigma_bearing_deg", parameters);
}

void read_association(const IniFile& ini, KfSlamIni& result) {
  AssociationParameters& association = result.parameters.association;
  association.method = "known_or_nearest";
  association.gate_probability = 0.99;
  ini.copy(kSlam, "data_assoc_IC_chi2_thres", "association.gate_probability", result.parameters);
  // In MRPT whatever is not a sighting is a new landmark at once.
  association.new_landmark_probability = association.gate_probability;
  association.confirm_after = 1;
  association.prune_after = 0;
  if (ini.choice(kSlam, "data_assoc_method", {"assocNN", "assocJCBB"}, 0) == 1)
    association.method = "known_or_joint";
  if (ini.choice(kSlam, "data_assoc_metric", {"metricMaha", "metricML"}, 1) == 0) {
    result.notes.emplace_back(
        "data_assoc_metric: among several partners the one with the least d^2 + log|S| is taken, "
        "as "
        "metricML does, not the one with the least d^2.");
  }
  if (ini.choice(kSlam, "data_assoc_IC_metric", {"metricMaha", "metricML"}, 0) == 1) {
    result.notes.emplace_back(
        "data_assoc_IC_metric: a gate by matching likelihood is not available; the chi-square gate "
        "of data_assoc_IC_chi2_thres holds.");
  }
}

/// What the sections of libslam add.
void read_additions(const IniFile& ini, const std::filesystem::path& path, Parameters& parameters) {
  try {
    load_parameters(ini.content(), parameters, kf_slam_option);
  } catch (const ConfigError& error) {
    throw ConfigError(path.string() + ": " + error.what());
  }
  AssociationParameters& association = parameters.association;
  association.new_landmark_probability =
      std::max(association.new_landmark_probability, association.gate_probability);
}

}  // namespace

KfSlamIni load_kf_slam_ini(const std::filesystem::path& path) {
  const IniFile ini(path);
  KfSlamIni result;
  read_files(ini, path, result);
  read_filter(ini, result);
  read_odometry(ini, result);
  read_sensor(ini, result.parameters);
  read_association(ini, result);
  read_additions(ini, path, result.parameters);
  append_remarks(ini.content(), result.notes);
  return result;
}

}  // namespace libslam
