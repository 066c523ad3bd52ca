#include <cmath>

#include <libslam/io/importers/victoria_park.hpp>
#include <libslam/io/input_file.hpp>

namespace libslam {
namespace {

// The vehicle, from the format note of the data set [m].
constexpr double kWheelbase = 2.83, kEncoderOffset = 0.76, kLaserAhead = 0.95 + 2.83,
                 kLaserLeft = 0.5;
constexpr double kMaxRange = 80.0;
constexpr double kHalfPi = 1.5707963267948966;
constexpr double kClockOrigin = 20967.0;  ///< [ms] of the aa3 clock at the zero of the ASCII clock

using Association = VictoriaParkOptions::Association;
using Steering = VictoriaParkOptions::Steering;

void read_odometry(const std::string& directory, const VictoriaParkOptions& options,
                   ImportedLog& log) {
  const bool aa3 = options.steering == Steering::kAa3;
  TextReader row(aa3 ? find_input_file(directory + "/tree_detections", "inputs.dat")
                     : find_input_file(directory + "/raw_ascii", "DRS.txt"));  // t, speed, steering
  while (row.next()) {
    const double speed = options.distortion.speed * row.number(1);
    const double steering = options.distortion.steering * row.number(2) + options.distortion.bias;
    if (std::abs(steering) > 1.3) row.reject("steering angle beyond 1.3 rad");
    const double curvature = std::tan(steering) / kWheelbase;
    const double centre_speed = speed / (1.0 - curvature * kEncoderOffset);
    log.add_velocity(row, row.number(0), {centre_speed, 0.0, centre_speed * curvature});
  }
}

/// Bearings of the laser run from 0 (right) to pi (left).
void read_trees(const std::string& directory, double max_diameter, ImportedLog& log) {
  TextReader row(find_input_file(directory + "/tree_detections", "measurements.dat"));
  while (row.next())  // t, range, bearing, diameter
    if (row.number(3) < max_diameter)
      log.add_sighting(row, row.number(0),
                       {kNoIdentity, row.number(1), row.number(2) - kHalfPi, {}});
}

void read_identified_trees(const std::string& directory, ImportedLog& log) {
  TextReader row(find_input_file(directory + "/known_association", "observations_with_ids.csv"));
  while (row.next()) {  // t [ms], range, bearing, x, y, id
    row.require_columns(6);
    const double time = (row.number(0) - kClockOrigin) / 1000.0;
    log.add_sighting(row, time, {row.integer(5), row.number(1), row.number(2) - kHalfPi, {}});
  }
}

void read_laser(const std::string& directory, ImportedLog& log) {
  log.laser.first_bearing = -kHalfPi;
  log.laser.resolution = kHalfPi / 180.0;
  log.laser.max_range = kMaxRange;
  log.laser.T_robot_sensor = log.T_robot_sensor;
  TextReader row(find_input_file(directory + "/raw_ascii", "LASER_one_scan_per_line.txt"));
  while (row.next()) {  // t, 361 ranges
    if (row.columns() != 362) row.reject("a scan has 361 ranges");
    log.add_laser_scan(row, row.number(0), 1);
  }
}

void read_gps(const std::string& directory, ImportedLog& log) {
  TextReader row(find_input_file(directory + "/raw_ascii", "GPS.txt"));  // t, north, east
  Trajectory& path = log.truth.path;
  path.has_heading = false;
  path.point_on_robot = {kLaserAhead, kLaserLeft};
  while (row.next()) {
    path.times.push_back(row.number(0));
    path.poses.emplace_back(row.number(2), row.number(1), 0.0);
  }
  log.remarks["path"] =
      "good GPS fixes: x east, y north, positions only; the place of the antenna on the truck is "
      "not documented: compared with the laser's, as is usual";
}

void describe(const VictoriaParkOptions& options, ImportedLog& log) {
  log.remarks["steering"] = options.steering == Steering::kAa3
                                ? "aa3 calibration"
                                : "DRS calibration (1.0592 aa3 + 0.0026 rad)";
  log.remarks["pose"] = "rear axle centre";
  log.parameters = {{"wheelbase", kWheelbase},
                    {"encoder_offset", kEncoderOffset},
                    {"distortion_speed", options.distortion.speed},
                    {"distortion_steering", options.distortion.steering},
                    {"distortion_steering_bias", options.distortion.bias}};
}

}  // namespace

ImportedLog import_victoria_park(const std::string& directory, const VictoriaParkOptions& options) {
  if (options.association == Association::kIsam)
    return import_victoria_park_isam(
        find_input_file(directory + "/isam_gtsam", "victoria_park.txt"));
  ImportedLog log;
  log.scenario = "Victoria Park";
  log.T_robot_sensor = {kLaserAhead, kLaserLeft, 0.0};
  log.field_of_view = 2.0 * kHalfPi;
  log.max_range = kMaxRange;
  describe(options, log);
  read_odometry(directory, options, log);
  if (options.association == Association::kKnown)
    read_identified_trees(directory, log);
  else if (options.association == Association::kRawScans)
    read_laser(directory, log);
  else
    read_trees(directory, options.max_diameter, log);
  read_gps(directory, log);
  return log;
}

}  // namespace libslam
