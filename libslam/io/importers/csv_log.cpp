#include <cmath>
#include <filesystem>

#include <libslam/io/arc_motion.hpp>
#include <libslam/io/importers/csv_log.hpp>
#include <libslam/io/input_error.hpp>

namespace libslam {
namespace {

/// Names of the columns, joined by commas.
std::string read_header(TextReader& row) {
  if (!row.next()) throw InputError(row.file() + ": holds no rows");
  std::string header;
  for (std::size_t i = 0; i < row.columns(); ++i) {
    if (i > 0) header += ',';
    header += row.word(i);
  }
  return header;
}

void read_poses(TextReader& row, ImportedLog& log) {
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  while (row.next()) {
    const Eigen::Vector3d pose(row.number(1), row.number(2), row.number(3));
    const bool first = log.odometry.empty();
    log.add_velocity(row, row.number(0), Eigen::Vector3d::Zero());
    ImportedOdometry& reading = log.odometry.back();
    reading.has_velocity = false;
    if (!first) {
      const double c = std::cos(last.z()), s = std::sin(last.z());
      const Eigen::Vector3d d = pose - last;
      reading.arc = arc_of_increment(
          {c * d.x() + s * d.y(), c * d.y() - s * d.x(), std::remainder(d.z(), 2.0 * M_PI)});
    }
    last = pose;
  }
}

void read_velocities(TextReader& row, ImportedLog& log) {
  while (row.next()) log.add_velocity(row, row.number(0), {row.number(1), 0.0, row.number(2)});
}

void read_ticks(TextReader& row, const CsvLogOptions& options, ImportedLog& log) {
  const Eigen::Vector2d metres_per_tick(options.metres_per_tick_left,
                                        options.metres_per_tick_right);
  while (row.next())
    log.add_ticks(row, row.number(0), {1, 2}, metres_per_tick, options.track_width);
  log.parameters = {{"track_width", options.track_width},
                    {"metres_per_tick_left", options.metres_per_tick_left},
                    {"metres_per_tick_right", options.metres_per_tick_right}};
}

void read_odometry(const CsvLogOptions& options, ImportedLog& log) {
  TextReader row(options.odometry);
  const std::string header = read_header(row);
  if (header == "t,x,y,phi")
    read_poses(row, log);
  else if (header == "t,v,omega")
    read_velocities(row, log);
  else if (header == "t,left_ticks,right_ticks")
    read_ticks(row, options, log);
  else
    row.reject("expected the header t,x,y,phi or t,v,omega or t,left_ticks,right_ticks");
  if (log.odometry.empty()) throw InputError(options.odometry + ": holds no readings");
}

void read_landmarks(const std::string& file, ImportedLog& log) {
  TextReader row(file);
  const std::string header = read_header(row);
  const bool with_sigmas = header == "t,id,range,bearing,sigma_range,sigma_bearing";
  if (!with_sigmas && header != "t,id,range,bearing")
    row.reject("expected the header t,id,range,bearing[,sigma_range,sigma_bearing]");
  while (row.next()) {
    ImportedSighting sighting{row.integer(1), row.number(2), row.number(3), {}};
    if (with_sigmas) {
      const Eigen::Vector2d sigma(row.number(4), row.number(5));
      if (!(sigma.array() > 0.0).all()) row.reject("standard deviations must be positive");
      sighting.cov = Eigen::Matrix2d(sigma.cwiseAbs2().asDiagonal());
    }
    log.add_sighting(row, row.number(0), sighting);
  }
}

void read_truth(const std::string& file, Trajectory& path) {
  TextReader row(file);
  const std::string header = read_header(row);
  if (header != "t,x,y,phi" && header != "t,x,y") row.reject("expected the header t,x,y[,phi]");
  path.has_heading = header == "t,x,y,phi";
  while (row.next()) {
    const double time = row.number(0);
    if (!path.times.empty() && time < path.times.back()) row.reject("time goes backwards");
    path.times.push_back(time);
    path.poses.emplace_back(row.number(1), row.number(2), path.has_heading ? row.number(3) : 0.0);
  }
}

}  // namespace

ImportedLog import_csv(const CsvLogOptions& options) {
  ImportedLog log;
  log.scenario = std::filesystem::path(options.odometry).filename().string();
  log.T_robot_sensor = options.T_robot_sensor;
  read_odometry(options, log);
  read_landmarks(options.landmarks, log);
  if (!options.truth.empty()) read_truth(options.truth, log.truth.path);
  return log;
}

}  // namespace libslam
