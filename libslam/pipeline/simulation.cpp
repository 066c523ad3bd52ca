#include <cmath>
#include <utility>

#include <libslam/config/yaml_loader.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/text_reader.hpp>
#include <libslam/io/truth_reader.hpp>
#include <libslam/pipeline/factory.hpp>
#include <libslam/pipeline/simulation.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

namespace {

/// Beyond this distance from the origin [m] a coordinate has lost its millimetres, and grids and
/// time limits computed from it would overflow.
constexpr double kFarthest = 1e6;

double coordinate(const TextReader& row, std::size_t column) {
  const double value = row.number(column);
  if (!(std::abs(value) <= kFarthest)) row.reject("a coordinate is beyond 1e6 m");
  return value;
}

void require_near(const std::string& file, const std::vector<TrueLandmark>& points) {
  for (const TrueLandmark& point : points)
    if (!(point.position.cwiseAbs().maxCoeff() <= kFarthest))
      throw InputError(file + ": point " + std::to_string(point.id) + " is beyond 1e6 m");
}

std::vector<Wall> read_walls(const std::string& file) {
  TextReader row(file);
  std::vector<Wall> walls;
  bool first = true;
  while (row.next()) {
    if (std::exchange(first, false) && row.word(0) == "x1") continue;
    if (row.columns() != 4) row.reject("a wall has the columns x1,y1,x2,y2");
    walls.push_back(
        {{coordinate(row, 0), coordinate(row, 1)}, {coordinate(row, 2), coordinate(row, 3)}});
  }
  return walls;
}

/// Identities travel through logs as 32-bit numbers, and -1 means none.
std::vector<TrueLandmark> read_landmarks(const std::string& file) {
  std::vector<TrueLandmark> landmarks = read_true_landmarks(file);
  for (const TrueLandmark& landmark : landmarks)
    if (landmark.id < 0 || landmark.id > INT32_MAX)
      throw InputError(file + ": landmark id " + std::to_string(landmark.id) +
                       " is none of 0 to 2147483647");
  require_near(file, landmarks);
  return landmarks;
}

World read_world(const WorldParameters& files, const DriveParameters& drive) {
  World world;
  world.landmarks = read_landmarks(files.landmarks_file);
  const std::vector<TrueLandmark> way_points = read_true_landmarks(files.way_points_file);
  require_near(files.way_points_file, way_points);
  for (const TrueLandmark& point : way_points)
    world.way_points.emplace_back(point.position.head<2>());
  if (!files.walls_file.empty()) world.walls = read_walls(files.walls_file);
  world.T_world_start = {drive.start_x, drive.start_y, to_radians(drive.start_heading_deg)};
  return world;
}

/// Depth at which a disparity is ten times its standard deviation: what starts there is Gaussian.
double known_depth(double focal_length, double baseline, double sigma_pixel) {
  return focal_length * baseline / (10.0 * std::sqrt(2.0) * sigma_pixel);
}

/// Walls in the scans of a laser whose beams are as noisy as it says, and which are straight.
void see_walls(const LaserSensorParameters& laser, Parameters& p) {
  p.measurement.model = "line";
  p.frontend.source = "scan_lines";
  p.frontend.max_range = laser.max_range;
  ScanLinesParameters& lines = p.frontend.lines;
  lines.sigma_range = std::max(laser.sigma_range, 1e-3);
  lines.floor_alpha_deg = lines.floor_r = 0.0;
  lines.split_distance = 5.0 * lines.sigma_range;
  p.association.method = "sequential_compatibility";
  p.association.confirm_after = 3;
  p.association.prune_after = 20;
  p.association.merge_every = 10;
}

/// The sensor whose sightings the filter uses: range and bearing, else points of a stereo camera,
/// else tags in its images, else walls for a laser.
void choose_sensor(const Scenario& scenario, Parameters& p) {
  const StereoSensorParameters& points = scenario.stereo;
  const StereoImagesParameters& images = scenario.stereo_images;
  if (!scenario.range_bearing.enabled && !points.enabled && !images.enabled &&
      scenario.laser.enabled)
    return see_walls(scenario.laser, p);
  if (scenario.range_bearing.enabled || (!points.enabled && !images.enabled)) {
    p.measurement.noise = "configured";
    p.measurement.sigma_range = scenario.range_bearing.sigma_range;
    p.measurement.sigma_bearing_deg = scenario.range_bearing.sigma_bearing_deg;
    return;
  }
  p.measurement.model = "stereo_point";
  if (points.enabled) {
    p.frontend.source = "stereo_points";
    p.measurement.stereo.sigma_pixel = points.sigma_pixel;
    p.frontend.max_range = known_depth(points.focal_length_px, points.baseline, points.sigma_pixel);
  } else {
    p.frontend.source = "fiducials";
    p.frontend.fiducials.points = "all";
    p.frontend.max_range =
        known_depth(images.focal_length_px, images.baseline, p.frontend.fiducials.sigma_pixel);
  }
}

InputParameters driven_by(const std::string& odometry) {
  InputParameters input;
  input.odometry = odometry;
  return input;
}

SimulatedVehicle make_vehicle(const Scenario& scenario) {
  MotionParameters motion = scenario.motion;
  motion.noise.from_log = false;  // the log's noise is made here
  const InputParameters logged = driven_by(scenario.log.odometry);
  SimulatedVehicle vehicle;
  vehicle.commanded = make_motion_model(motion, {}, driven_by("velocities"));
  vehicle.logged = make_motion_model(motion, {}, logged);
  vehicle.actual = make_motion_model(motion, calibration_of(scenario.truth), logged);
  return vehicle;
}

}  // namespace

Scenario load_scenario(const std::filesystem::path& file, ParameterPlaces* places) {
  Scenario scenario;
  load_yaml(ParameterTable(scenario), file, places);
  resolve_world_files(scenario, file.parent_path());
  return scenario;
}

void resolve_world_files(Scenario& scenario, const std::filesystem::path& directory) {
  WorldParameters& world = scenario.world;
  for (std::string* name : {&world.landmarks_file, &world.way_points_file, &world.walls_file})
    if (!name->empty()) *name = (directory / *name).string();
}

Parameters nominal_filter(const Scenario& scenario) {
  Parameters p;
  p.input.odometry = scenario.log.odometry;
  p.motion = scenario.motion;
  p.motion.noise.from_log = false;
  choose_sensor(scenario, p);
  if (p.measurement.model == "line") return p;  // walls have no identities
  p.association.gate_probability = 1.0;
  const bool tags = p.frontend.source == "fiducials";  // they have numbers of their own
  if (tags) p.association.gate_probability = 0.999;    // and their corners errors of their own
  if (!scenario.log.identities && !tags) {
    p.association.method = "nearest_neighbour";
    p.association.gate_probability = 0.99;
  }
  return p;
}

World make_world(const Scenario& scenario) {
  if (scenario.world.generator == "random") return make_random_world(scenario.world);
  if (scenario.world.generator == "rooms") return make_rooms(scenario.world);
  return read_world(scenario.world, scenario.drive);
}

std::unique_ptr<Simulator> make_simulator(const Scenario& scenario, std::uint64_t seed) {
  return std::make_unique<Simulator>(scenario, make_world(scenario), make_vehicle(scenario), seed);
}

}  // namespace libslam
