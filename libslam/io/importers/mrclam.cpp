#include <algorithm>

#include <libslam/io/importers/mrclam.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/input_file.hpp>

namespace libslam {
namespace {

constexpr std::int64_t kFirstLandmark = 6;
constexpr double kTruthPeriod =
    0.02;  // [s]; the robots move below 0.3 m/s: under 3 mm to the nearest row

/// Rows (t, v, omega) in the order of time: data set 9 begins with one row out of order.
std::vector<Eigen::Vector3d> read_commands(TextReader& row) {
  std::vector<Eigen::Vector3d> commands;
  while (row.next()) commands.emplace_back(row.number(0), row.number(1), row.number(2));
  if (commands.empty()) throw InputError(row.file() + ": holds no rows");
  std::stable_sort(commands.begin(), commands.end(),
                   [](const auto& a, const auto& b) { return a[0] < b[0]; });
  return commands;
}

void read_odometry(const std::string& file, ImportedLog& log) {
  TextReader row(file);
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& command : read_commands(row)) {
    log.add_velocity(row, command[0], velocity);
    velocity = {command[1], 0.0, command[2]};
  }
}

std::map<std::int64_t, std::int64_t> read_barcodes(const std::string& file) {
  TextReader row(file);  // subject, barcode
  std::map<std::int64_t, std::int64_t> subjects;
  while (row.next()) subjects[row.integer(1)] = row.integer(0);
  return subjects;
}

void read_measurements(const std::string& directory, const std::string& prefix, ImportedLog& log) {
  const auto subjects = read_barcodes(find_input_file(directory, "Barcodes.dat"));
  TextReader row(
      find_input_file(directory, prefix + "Measurement.dat"));  // t, barcode, range, bearing
  std::int64_t robots = 0, unknown = 0;
  while (row.next()) {
    const auto subject = subjects.find(row.integer(1));
    if (subject == subjects.end())
      ++unknown;
    else if (subject->second < kFirstLandmark)
      ++robots;
    else
      log.add_sighting(row, row.number(0), {subject->second, row.number(2), row.number(3), {}});
  }
  log.remarks["left_out"] = std::to_string(robots) + " sightings of other robots, " +
                            std::to_string(unknown) + " of unknown barcodes";
}

void read_path(const std::string& file, ImportedLog& log) {
  const double begin = log.odometry.front().time - kTruthPeriod;
  const double end = log.odometry.back().time + kTruthPeriod;
  Trajectory& path = log.truth.path;
  TextReader row(file);  // t, x, y, theta
  while (row.next()) {
    const double time = row.number(0);
    if (time < begin || time > end) continue;
    if (!path.times.empty() && time < path.times.back() + kTruthPeriod - 1e-6) continue;
    path.times.push_back(time);
    path.poses.emplace_back(row.number(1), row.number(2), row.number(3));
  }
}

}  // namespace

ImportedLog import_mrclam(const std::string& directory, int robot) {
  const std::string prefix = "Robot" + std::to_string(robot) + "_";
  ImportedLog log;
  log.scenario = "UTIAS MRCLAM, robot " + std::to_string(robot);
  read_odometry(find_input_file(directory, prefix + "Odometry.dat"), log);
  read_measurements(directory, prefix, log);
  TextReader landmark(
      find_input_file(directory, "Landmark_Groundtruth.dat"));  // subject, x, y, sigmas
  while (landmark.next())
    log.truth.landmarks.push_back(
        {landmark.integer(0), Eigen::Vector2d(landmark.number(1), landmark.number(2))});
  const std::string path = find_optional_input_file(directory, prefix + "Groundtruth.dat");
  if (!path.empty()) read_path(path, log);
  log.remarks["path"] =
      path.empty() ? "not part of the data set" : "robot centre, from Vicon, 50 Hz";
  return log;
}

}  // namespace libslam
