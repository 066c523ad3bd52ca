#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <libslam/io/importers/censi.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/input_file.hpp>

namespace libslam {
namespace {

constexpr double kLongestInterval = 60.0;  ///< [s]; longer ones are garbage
constexpr double kFastestWheel = 100.0;    ///< [rad/s]
constexpr double kEncoderSigma = 5e-5;     ///< [m], one step of the encoders (2.9 mrad/s) per row
constexpr double kClockSigma = 0.1;        ///< [s] between wheels and scans

/// One row of the data set.
struct Tuple {
  double interval = 0.0;   ///< [s]
  Eigen::Vector2d wheels;  ///< mean velocity left, right [rad/s]
  Eigen::Vector3d moved;   ///< displacement of the laser [m, m, rad]
};

std::vector<Tuple> read_tuples(const std::string& file) {
  TextReader row(file);
  std::vector<Tuple> tuples;
  while (row.next()) {
    row.require_columns(6);
    Tuple& tuple = tuples.emplace_back();
    tuple.interval = row.number(0);
    tuple.wheels = {row.number(1), row.number(2)};
    tuple.moved = {row.number(3), row.number(4), row.number(5)};
    if (!(tuple.interval > 0.0 && tuple.interval < kLongestInterval))
      row.reject("interval must be positive and below 60 s");
    if (tuple.wheels.cwiseAbs().maxCoeff() > kFastestWheel)
      row.reject("wheel velocity beyond 100 rad/s");
  }
  if (tuples.empty()) throw InputError(file + ": holds no tuples");
  return tuples;
}

/// The larger change of wheel velocity towards the row before and the row after; the robot stands
/// before the first and after the last.
Eigen::Vector2d velocity_change(const std::vector<Tuple>& tuples, std::size_t i) {
  const Eigen::Vector2d still = Eigen::Vector2d::Zero();
  const Eigen::Vector2d& before = i > 0 ? tuples[i - 1].wheels : still;
  const Eigen::Vector2d& after = i + 1 < tuples.size() ? tuples[i + 1].wheels : still;
  return (tuples[i].wheels - before).cwiseAbs().cwiseMax((tuples[i].wheels - after).cwiseAbs());
}

ImportedOdometry odometry_of(const std::vector<Tuple>& tuples, std::size_t i, double time,
                             const CensiOptions& options) {
  const Tuple& tuple = tuples[i];
  ImportedOdometry reading;
  reading.time = time;
  reading.dt = tuple.interval;
  const Eigen::Vector2d travel = options.nominal_radius * tuple.interval * tuple.wheels;
  const double along = 0.5 * travel.sum(), turn = (travel[1] - travel[0]) / options.nominal_track;
  reading.arc = {along, 0.0, turn};

  const Eigen::Vector2d variance =
      (options.nominal_radius * kClockSigma * velocity_change(tuples, i)).cwiseAbs2() +
      Eigen::Vector2d::Constant(kEncoderSigma * kEncoderSigma);
  const Eigen::Vector2d chord(std::cos(0.5 * turn), std::sin(0.5 * turn));
  // (along, turn) -> (dx, dy, dphi); that a turn shortens the chord is of second order.
  Eigen::Matrix<double, 3, 2> by_movement;
  by_movement << chord.x(), -0.5 * along * chord.y(), chord.y(), 0.5 * along * chord.x(), 0.0, 1.0;
  Eigen::Matrix2d by_wheels;
  by_wheels << 0.5, 0.5, -1.0 / options.nominal_track, 1.0 / options.nominal_track;
  const Eigen::Matrix<double, 3, 2> spread = by_movement * by_wheels;
  reading.cov_increment = spread * variance.asDiagonal() * spread.transpose();
  return reading;
}

Eigen::Vector3d compose(const Eigen::Vector3d& pose, const Eigen::Vector3d& moved) {
  Eigen::Vector3d composed = pose + moved;
  composed.head<2>() = pose.head<2>() + Eigen::Rotation2Dd(pose[2]) * moved.head<2>();
  composed[2] = std::remainder(composed[2], 2.0 * M_PI);
  return composed;
}

void read_published_result(const std::string& file, const CensiOptions& options, ImportedLog& log) {
  require_input_file(file);
  try {
    std::ifstream in(file);
    const auto json = nlohmann::json::parse(in);
    const auto& cov = json.at("covariance");  // of both radii, track, sensor pose
    // Published wheel sizes are diameters.
    const std::array<std::tuple<const char*, const char*, double>, 6> entries{
        {{"scale_left", "l_diam", 2.0 * options.nominal_radius},
         {"scale_right", "r_diam", 2.0 * options.nominal_radius},
         {"track_width", "axle", options.nominal_track},
         {"sensor_x", "l_x", 1.0},
         {"sensor_y", "l_y", 1.0},
         {"sensor_phi", "l_theta", 1.0}}};
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const auto& [name, key, nominal] = entries[i];
      const double unit = i < 2 ? options.nominal_radius : nominal;
      log.truth.calibration[name] = json.at(key).get<double>() / nominal;
      log.parameters[std::string("published_sigma_") + name] =
          std::sqrt(cov.at(i).at(i).get<double>()) / unit;
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file + ": " + error.what());
  }
}

}  // namespace

ImportedLog import_censi(const std::string& directory, const CensiOptions& options) {
  ImportedLog log;
  log.scenario = "Censi odometry calibration, " + options.subset;
  log.as_pairs = true;
  log.parameters = {{"nominal_radius", options.nominal_radius},
                    {"nominal_track", options.nominal_track}};
  log.remarks["calibration"] =
      "published batch result; scale_left, scale_right: wheel radius / nominal_radius, "
      "track_width: "
      "axle / nominal_track, sensor_x, sensor_y, sensor_phi: laser on the robot [m, m, rad]";
  const auto tuples = read_tuples(find_input_file(directory + "/csv", options.subset + ".csv"));
  read_published_result(find_input_file(directory + "/results", options.subset + "_results.json"),
                        options, log);
  double time = 0.0;
  log.odometry.push_back({});
  log.sensor_path.push_back({});
  for (std::size_t i = 0; i < tuples.size(); ++i) {
    time += tuples[i].interval;
    log.odometry.push_back(odometry_of(tuples, i, time, options));
    log.sensor_path.push_back({time, compose(log.sensor_path.back().pose, tuples[i].moved)});
  }
  return log;
}

}  // namespace libslam
