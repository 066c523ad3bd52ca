#include <cmath>

#include <libslam/io/importers/lost_in_the_woods.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/input_file.hpp>

namespace libslam {
namespace {

std::map<std::string, double> read_parameters(const std::string& file) {
  TextReader row(file);
  std::map<std::string, double> values;
  while (row.next()) {  // "name = value"
    row.require_columns(3);
    values[std::string(row.word(0))] = row.number(2);
  }
  for (const char* name : {"d", "r_var", "b_var"})
    if (!values.contains(name)) throw InputError(file + ": " + name + " is missing");
  return values;
}

void read_odometry(const std::string& file, ImportedLog& log) {
  TextReader row(file);  // k, t, v, omega, x, y, theta, valid
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  while (row.next()) {
    row.require_columns(8);
    const double time = row.number(1);
    log.add_velocity(row, time, velocity);
    velocity = {row.number(2), 0.0, row.number(3)};
    if (row.number(7) == 0.0) continue;
    log.truth.path.times.push_back(time);
    log.truth.path.poses.emplace_back(row.number(4), row.number(5), row.number(6));
  }
}

}  // namespace

ImportedLog import_lost_in_the_woods(const std::string& directory) {
  ImportedLog log;
  log.scenario = "UTIAS Lost in the Woods";
  log.parameters = read_parameters(find_input_file(directory, "params.txt"));
  log.T_robot_sensor.x() = log.parameters["d"];
  log.sigma_range = std::sqrt(log.parameters["r_var"]);
  log.sigma_bearing = std::sqrt(log.parameters["b_var"]);
  read_odometry(find_input_file(directory, "odometry_and_groundtruth.csv"), log);
  TextReader row(find_input_file(directory, "range_bearing.csv"));  // k, t, id, range, bearing
  while (row.next())
    log.add_sighting(row, row.number(1), {row.integer(2), row.number(3), row.number(4), {}});
  TextReader landmark(find_input_file(directory, "landmarks.csv"));  // id, x, y
  while (landmark.next())
    log.truth.landmarks.push_back(
        {landmark.integer(0), Eigen::Vector2d(landmark.number(1), landmark.number(2))});
  log.remarks["path"] = "robot centre, from Vicon; rows where Vicon lost the robot are left out";
  return log;
}

}  // namespace libslam
