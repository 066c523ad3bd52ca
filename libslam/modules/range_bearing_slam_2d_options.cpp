#include <algorithm>
#include <ostream>
#include <string>

#include <mrpt/bayes/CKalmanFilterCapable.h>
#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/core/bits_math.h>
#include <mrpt/slam/data_association.h>

#include <libslam/config/config_error.hpp>
#include <libslam/config/ini_parameters.hpp>
#include <libslam/config/validation.hpp>
#include <libslam/modules/range_bearing_slam_2d.hpp>

namespace libslam {

namespace {

using mrpt::DEG2RAD;
using mrpt::RAD2DEG;
using mrpt::bayes::TKFMethod;
using mrpt::config::CConfigFileBase;
using mrpt::slam::TDataAssociationMethod;
using mrpt::slam::TDataAssociationMetric;

template <typename Enum>
void read_enum(const CConfigFileBase& source, const std::string& section, const char* key,
               int& value) {
  value = source.read_enum<Enum>(section, key, static_cast<Enum>(value));
}

}  // namespace

RangeBearingSlam2D::TOptions::TOptions() : stds_Q_no_odo(3), std_sensor_yaw(DEG2RAD(0.5f)) {
  stds_Q_no_odo[0] = stds_Q_no_odo[1] = 0.10f;
  stds_Q_no_odo[2] = DEG2RAD(4.0f);
  parameters.filter.error_frame = "standard";
  parameters.measurement.noise = "configured";
  parameters.association.method = "known_or_nearest";
  parameters.association.new_landmark_probability = 0.0;
}

void RangeBearingSlam2D::TOptions::loadFromConfigFile(const CConfigFileBase& source,
                                                      const std::string& section) {
  auto& stds = stds_Q_no_odo;
  if (source.keyExists(section, "stdXY_no_odo"))
    stds[0] = stds[1] = source.read_float(section, "stdXY_no_odo", stds[0]);
  stds[2] = source.read_float(section, "stdPhi_no_odo_deg", RAD2DEG(stds[2]));
  source.read_vector(section, "stds_Q_no_odo", stds, stds);
  if (stds.size() != 3)
    throw ConfigError(place_in_ini(section, "stds_Q_no_odo") + "takes x y phi_deg");
  stds[2] = DEG2RAD(stds[2]);
  if (source.read_bool(section, "force_ignore_odometry", false)) parameters.input.odometry = "none";

  std_sensor_range = source.read_float(section, "std_sensor_range", std_sensor_range);
  std_sensor_yaw =
      DEG2RAD(source.read_float(section, "std_sensor_yaw_deg", RAD2DEG(std_sensor_yaw)));
  MRPT_LOAD_CONFIG_VAR(quantiles_3D_representation, float, source, section);
  MRPT_LOAD_CONFIG_VAR(create_simplemap, bool, source, section);
  read_enum<TDataAssociationMethod>(source, section, "data_assoc_method", data_assoc_method);
  read_enum<TDataAssociationMetric>(source, section, "data_assoc_metric", data_assoc_metric);
  read_enum<TDataAssociationMetric>(source, section, "data_assoc_IC_metric", data_assoc_IC_metric);
  MRPT_LOAD_CONFIG_VAR(data_assoc_IC_chi2_thres, double, source, section);
  MRPT_LOAD_CONFIG_VAR(data_assoc_IC_ml_threshold, double, source, section);
  load_parameters(source, parameters, kf_slam_option);
}

void RangeBearingSlam2D::TOptions::dumpToTextStream(std::ostream& out) const {
  out << "\n----------- [RangeBearingSlam2D::TOptions] ------------ \n\n";
  LOADABLEOPTS_DUMP_VAR(stds_Q_no_odo[0], float);
  LOADABLEOPTS_DUMP_VAR(stds_Q_no_odo[1], float);
  LOADABLEOPTS_DUMP_VAR_DEG(stds_Q_no_odo[2]);
  LOADABLEOPTS_DUMP_VAR(std_sensor_range, float);
  LOADABLEOPTS_DUMP_VAR_DEG(std_sensor_yaw);
  LOADABLEOPTS_DUMP_VAR(quantiles_3D_representation, float);
  LOADABLEOPTS_DUMP_VAR(create_simplemap, bool);
  LOADABLEOPTS_DUMP_VAR(data_assoc_method, int);
  LOADABLEOPTS_DUMP_VAR(data_assoc_metric, int);
  LOADABLEOPTS_DUMP_VAR(data_assoc_IC_chi2_thres, double);
  LOADABLEOPTS_DUMP_VAR(data_assoc_IC_metric, int);
  LOADABLEOPTS_DUMP_VAR(data_assoc_IC_ml_threshold, double);
  dump_parameters(out, parameters, kf_slam_option);
}

Parameters RangeBearingSlam2D::TOptions::getEffectiveParameters() const {
  if (stds_Q_no_odo.size() != 3 || stds_Q_no_odo[0] != stds_Q_no_odo[1])
    throw ConfigError("stds_Q_no_odo: takes x, y, phi with x equal to y");
  Parameters p = parameters;
  p.measurement.sigma_range = std_sensor_range;
  p.measurement.sigma_bearing_deg = RAD2DEG(static_cast<double>(std_sensor_yaw));
  p.motion.no_odometry_sigma_xy = stds_Q_no_odo[0];
  p.motion.no_odometry_sigma_heading_deg = RAD2DEG(static_cast<double>(stds_Q_no_odo[2]));
  p.association.gate_probability = data_assoc_IC_chi2_thres;
  p.association.new_landmark_probability =
      std::max(p.association.new_landmark_probability, data_assoc_IC_chi2_thres);
  validate(p);
  return p;
}

void RangeBearingSlam2D::TKalmanOptions::loadFromConfigFile(const CConfigFileBase& source,
                                                            const std::string& section) {
  read_enum<TKFMethod>(source, section, "method", method);
}

void RangeBearingSlam2D::TKalmanOptions::dumpToTextStream(std::ostream& out) const {
  out << "\n----------- [RangeBearingSlam2D::TKalmanOptions] ------------ \n\n";
  LOADABLEOPTS_DUMP_VAR(method, int);
}

void RangeBearingSlam2D::loadOptions(const CConfigFileBase& ini) {
  const std::string kalman = "RangeBearingKFSLAM_KalmanFilter";
  options.loadFromConfigFile(ini, "RangeBearingKFSLAM");
  KF_options.loadFromConfigFile(ini, kalman);
  setMinLoggingLevel(
      ini.read_enum<mrpt::system::VerbosityLevel>(kalman, "verbosity_level", getMinLoggingLevel()));
}

}  // namespace libslam
