#pragma once
// A simulated drive as a configuration: world, vehicle, sensors, and what is wrong with them.
//
// Described like libslam/config/parameters.hpp: loader, help, `--set` and the effective file are
// visits of the same description.

#include <string>

#include <libslam/config/parameters.hpp>
#include <libslam/simulation/fault_parameters.hpp>
#include <libslam/simulation/sensor_parameters.hpp>

namespace libslam {

/// Section `world`.
struct WorldParameters {
  std::string generator = "random";
  std::string landmarks_file, way_points_file, walls_file;
  int seed = 1;
  int landmarks = 50;
  int way_points = 12;
  double size_x = 120.0, size_y = 100.0;
  int rooms_x = 3, rooms_y = 2;
  double room_size_x = 6.0, room_size_y = 5.0;
  double door_width = 1.0;
  double max_height = 0.0;
  double trunk_radius = 0.0;

  void describe(auto& v) {
    v.value("generator", generator,
            {"",
             "Where the world comes from: CSV files, scattered landmarks around a closed lap, or "
             "rooms joined by doors.",
             0,
             0,
             {"file", "random", "rooms"}});
    v.value("landmarks_file", landmarks_file,
            {"", "Landmarks `id,x,y[,z]`; relative names start at the scenario file (file)."});
    v.value("way_points_file", way_points_file, {"", "Way-points `id,x,y` in order (file)."});
    v.value("walls_file", walls_file, {"", "Walls `x1,y1,x2,y2`; empty: none (file)."});
    v.value("seed", seed,
            {"1", "Seed of the world, apart from that of the drive (random, rooms).", 0});
    v.value("landmarks", landmarks, {"1", "Number of landmarks (random, rooms).", 0, 10'000'000});
    v.value("way_points", way_points, {"1", "Number of way-points (random).", 3, 1'000'000});
    v.value("size_x", size_x, {"m", "Extent of the world (random).", 1});
    v.value("size_y", size_y, {"m", "Extent of the world (random).", 1});
    v.value("rooms_x", rooms_x, {"1", "Rooms in a row (rooms).", 1, 1000});
    v.value("rooms_y", rooms_y, {"1", "Rows of rooms (rooms).", 1, 1000});
    v.value("room_size_x", room_size_x, {"m", "Inner length of a room (rooms).", 1});
    v.value("room_size_y", room_size_y, {"m", "Inner width of a room (rooms).", 1});
    v.value("door_width", door_width, {"m", "Width of the doors (rooms).", 0.1});
    v.value("max_height", max_height,
            {"m", "Landmarks have heights up to this one, uniformly (random, rooms).", 0});
    v.value("trunk_radius", trunk_radius,
            {"m", "Landmarks are round trunks for the laser; 0: it does not see them.", 0});
  }
};

/// Section `drive`.
struct DriveParameters {
  double speed = 3.0;
  int laps = 1;
  double max_duration_s = 0.0;
  double way_point_radius = 1.0;
  double control_period_s = 0.025;
  double observation_period_s = 0.2;
  double steering_limit_deg = 45.0;
  double steering_rate_deg_s = 20.0;
  double turn_rate_limit_deg_s = 60.0;
  double turn_gain = 2.0;
  double start_x = 0.0, start_y = 0.0, start_heading_deg = 0.0;

  void describe(auto& v) {
    v.value("speed", speed, {"m/s", "Commanded speed of the axle centre.", 1e-6});
    v.value("laps", laps, {"1", "Rounds over all way-points.", 1, 1'000'000});
    v.value("max_duration_s", max_duration_s,
            {"s", "End after this time even if laps are missing; 0: no such end.", 0});
    v.value("way_point_radius", way_point_radius,
            {"m", "A way-point counts as reached within this distance.", 1e-6});
    v.value("control_period_s", control_period_s, {"s", "Time between two commands.", 1e-4});
    v.value("observation_period_s", observation_period_s,
            {"s", "Time between two observations, a multiple of control_period_s.", 1e-4});
    v.value("steering_limit_deg", steering_limit_deg,
            {"deg", "Largest steering angle (ackermann).", 0.1, 80});
    v.value("steering_rate_deg_s", steering_rate_deg_s,
            {"deg/s", "Fastest change of the steering angle (ackermann).", 0.01});
    v.value("turn_rate_limit_deg_s", turn_rate_limit_deg_s,
            {"deg/s", "Fastest turn (differential, odometry_increment).", 0.01});
    v.value("turn_gain", turn_gain,
            {"1/s", "Turn rate per heading error (differential, odometry_increment).", 1e-3});
    v.value("start_x", start_x, {"m", "Start pose (file; else the first way-point).", -1e6, 1e6});
    v.value("start_y", start_y, {"m", "Start pose (file).", -1e6, 1e6});
    v.value("start_heading_deg", start_heading_deg, {"deg", "Start heading (file)."});
  }
};

/// Section `truth`: how vehicle and sensors differ from what the log and the nominal model say.
struct TruthParameters {
  double scale_left = 1.0, scale_right = 1.0;
  double track_width = 1.0;
  double scale_speed = 1.0;
  double scale_steering = 1.0;
  double bias_steering_deg = 0.0;
  double sensor_x = 0.0, sensor_y = 0.0, sensor_heading_deg = 0.0;

  void describe(auto& v) {
    v.value("scale_left", scale_left, {"1", "True travel of the left wheel per nominal.", 1e-3});
    v.value("scale_right", scale_right, {"1", "True travel of the right wheel per nominal.", 1e-3});
    v.value("track_width", track_width, {"1", "True track width per nominal.", 1e-3});
    v.value("scale_speed", scale_speed, {"1", "True speed per nominal.", 1e-3});
    v.value("scale_steering", scale_steering, {"1", "True steering angle per nominal.", 1e-3});
    v.value("bias_steering_deg", bias_steering_deg,
            {"deg", "True steering angle when the nominal one is 0.", -80, 80});
    v.value("sensor_x", sensor_x,
            {"m", "Sensors sit this much further forward (robot frame) than the log says."});
    v.value("sensor_y", sensor_y, {"m", "The same to the left."});
    v.value("sensor_heading_deg", sensor_heading_deg, {"deg", "The same in heading."});
  }
};

/// Section `log`.
struct LogParameters {
  std::string flavour = "pairs";
  std::string odometry = "increments";
  bool identities = true;

  void describe(auto& v) {
    v.value("flavour", flavour,
            {"",
             "pairs: an (action, frame) pair per command, its frame empty between observations; "
             "merged_pairs: a pair per observation, what MRPT's filters want; observations: "
             "absolute odometry and observations one after another.",
             0,
             0,
             {"pairs", "merged_pairs", "observations"}});
    v.value("odometry", odometry,
            {"",
             "Field of the log that holds what the vehicle read; pose increments are always "
             "written beside it.",
             0,
             0,
             {"increments", "velocities", "ticks"}});
    v.value("identities", identities, {"", "Sightings carry the identity of their landmark."});
  }
};

/// A complete simulated drive.
struct Scenario {
  int seed = 1;
  WorldParameters world;
  DriveParameters drive;
  MotionParameters motion;
  TruthParameters truth;
  RangeBearingSensorParameters range_bearing;
  BeaconSensorParameters beacons;
  LaserSensorParameters laser;
  StereoSensorParameters stereo;
  StereoImagesParameters stereo_images;
  FaultParameters faults;
  LogParameters log;

  void describe(auto& v) {
    v.value("seed", seed, {"1", "Seed of the drive: motion noise, sensor noise, faults.", 0});
    v.section("world", world);
    v.section("drive", drive);
    v.section("motion", motion);
    v.section("truth", truth);
    v.section("range_bearing", range_bearing);
    v.section("beacons", beacons);
    v.section("laser", laser);
    v.section("stereo", stereo);
    v.section("stereo_images", stereo_images);
    v.section("faults", faults);
    v.section("log", log);
  }
};

}  // namespace libslam
