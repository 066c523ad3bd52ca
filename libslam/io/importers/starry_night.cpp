#include <array>
#include <cmath>

#include <libslam/io/importers/starry_night.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/input_file.hpp>
#include <libslam/io/text_reader.hpp>
#include <libslam/state/so3.hpp>

namespace libslam {
namespace {

using Values = std::map<std::string, std::vector<double>>;

constexpr std::array<const char*, 4> kPixelNames = {"sigma_u_left", "sigma_v_left", "sigma_u_right",
                                                    "sigma_v_right"};

/// "name = number ..." with the counts that the data set has.
Values read_parameters(const std::string& file) {
  static const std::map<std::string, std::size_t> kCounts = {
      {"C_c_v", 9}, {"rho_v_c_v", 3}, {"fu", 1},    {"fv", 1},    {"cu", 1},
      {"cv", 1},    {"b", 1},         {"v_var", 3}, {"w_var", 3}, {"y_var", 4}};
  TextReader row(file);
  Values values;
  while (row.next()) {
    std::vector<double>& list = values[std::string(row.word(0))];
    for (std::size_t i = 2; i < row.columns(); ++i) list.push_back(row.number(i));
  }
  for (const auto& [name, count] : kCounts)
    if (values[name].size() != count)
      throw InputError(file + ": " + name + " must have " + std::to_string(count) + " numbers");
  return values;
}

void read_camera(const std::string& file, const Values& values, SpatialLog& log) {
  StereoCamera& camera = log.camera;
  camera.fx = values.at("fu")[0];
  camera.fy = values.at("fv")[0];
  camera.cx = values.at("cu")[0];
  camera.cy = values.at("cv")[0];
  camera.baseline = values.at("b")[0];
  if (!(camera.fx > 0.0 && camera.fy > 0.0 && camera.baseline > 0.0))
    throw InputError(file + ": focal lengths and baseline must be positive");
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> C_c_v(
      values.at("C_c_v").data());
  if (!(C_c_v * C_c_v.transpose()).isIdentity(1e-6) || C_c_v.determinant() < 0.0)
    throw InputError(file + ": C_c_v is no rotation");
  camera.T_robot_camera = Eigen::Translation3d(Eigen::Vector3d(values.at("rho_v_c_v").data())) *
                          Eigen::Quaterniond(Eigen::Matrix3d(C_c_v.transpose())).normalized();
}

void keep_noise(const std::string& file, const Values& values, SpatialLog& log) {
  const auto keep = [&](const std::string& name, double variance) {
    if (!(variance > 0.0)) throw InputError(file + ": variances must be positive");
    log.parameters[name] = std::sqrt(variance);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    keep("sigma_speed_" + axis, values.at("v_var")[i]);
    keep("sigma_rate_" + axis, values.at("w_var")[i]);
  }
  for (std::size_t i = 0; i < kPixelNames.size(); ++i) keep(kPixelNames[i], values.at("y_var")[i]);
}

void read_motion(const std::string& file, SpatialLog& log) {
  TextReader row(file);  // k, t, theta (3), r (3), v (3), omega (3)
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();
  while (row.next()) {
    row.require_columns(14);
    const auto vector = [&](std::size_t first) {
      return Eigen::Vector3d(row.number(first), row.number(first + 1), row.number(first + 2));
    };
    SpatialStep step;
    step.time = row.number(1);
    step.twist = twist;
    if (!log.steps.empty() && step.time <= log.steps.back().time)
      row.reject("time does not increase");
    if (row.integer(0) != static_cast<std::int64_t>(log.steps.size()) + 1)
      row.reject("k does not count the rows");
    log.truth.path.times.push_back(step.time);
    const SpatialPose pose{vector(5), so3_exp(vector(2))};
    log.truth.path.spatial.push_back(pose);
    log.truth.path.poses.push_back(shadow_of(pose));
    twist << vector(8), vector(11);
    log.steps.push_back(std::move(step));
  }
  if (log.steps.empty()) throw InputError(file + ": holds no rows");
}

void read_sightings(const std::string& file, SpatialLog& log) {
  TextReader row(file);  // k, t, j, u_left, v_left, u_right, v_right
  while (row.next()) {
    row.require_columns(7);
    const std::int64_t k = row.integer(0), id = row.integer(2);
    if (k < 1 || k > static_cast<std::int64_t>(log.steps.size())) row.reject("no such step");
    if (id < 0 || id > INT32_MAX) row.reject("landmark id out of range");
    log.steps[static_cast<std::size_t>(k - 1)].sightings.push_back(
        {id, {row.number(3), row.number(4), row.number(5), row.number(6)}});
  }
}

}  // namespace

SpatialLog import_starry_night(const std::string& directory) {
  SpatialLog log;
  log.scenario = "UTIAS Starry Night";
  const std::string parameters = find_input_file(directory, "params.txt");
  const Values values = read_parameters(parameters);
  read_camera(parameters, values, log);
  keep_noise(parameters, values, log);
  read_motion(find_input_file(directory, "groundtruth_and_imu.csv"), log);
  read_sightings(find_input_file(directory, "stereo_observations.csv"), log);
  TextReader landmark(find_input_file(directory, "landmarks.csv"));  // id, x, y, z
  while (landmark.next())
    log.truth.landmarks.push_back(
        {landmark.integer(0),
         Eigen::Vector3d(landmark.number(1), landmark.number(2), landmark.number(3))});
  log.remarks["path"] = "vehicle frame of the camera head, from Vicon";
  return log;
}

Eigen::Vector4d starry_night_sigma(const SpatialLog& log) {
  Eigen::Vector4d sigma;
  for (std::size_t i = 0; i < kPixelNames.size(); ++i)
    sigma[static_cast<Eigen::Index>(i)] = log.parameters.at(kPixelNames[i]);
  return sigma;
}

}  // namespace libslam
