#include <algorithm>
#include <exception>
#include <string>

#include <libslam/config/version.hpp>
#include <libslam/config/yaml_loader.hpp>
#include <libslam/io/simulated_log.hpp>
#include <libslam/map/csv_text.hpp>
#include <libslam/pipeline/simulated_drive.hpp>
#include <libslam/pipeline/simulation.hpp>
#include <libslam/result/atomic_file.hpp>
#include <libslam/simulation/tag_plate.hpp>

namespace libslam {

namespace {

namespace fs = std::filesystem;

fs::path beside(const fs::path& rawlog, const char* ending) {
  fs::path file = rawlog;
  return file.replace_extension(ending);
}

void append_row(std::string& text, std::initializer_list<double> numbers) {
  const char* separator = "";
  for (const double number : numbers) {
    text += separator;
    append_number(text, number);
    separator = ",";
  }
  text += '\n';
}

std::string way_points_text(const World& world) {
  std::string text = "id,x,y\n";
  for (std::size_t i = 0; i < world.way_points.size(); ++i)
    append_row(text,
               {static_cast<double>(i + 1), world.way_points[i].x(), world.way_points[i].y()});
  return text;
}

std::string walls_text(const World& world) {
  std::string text = "x1,y1,x2,y2\n";
  for (const Wall& wall : world.walls)
    append_row(text, {wall.from.x(), wall.from.y(), wall.to.x(), wall.to.y()});
  return text;
}

/// The scenario with the files of its world beside the log.
Scenario make_portable(Scenario scenario, const World& world, const fs::path& rawlog) {
  if (scenario.world.generator != "file") return scenario;
  const fs::path way_points = beside(rawlog, ".way_points.csv");
  replace_file(way_points, way_points_text(world));
  scenario.world.way_points_file = way_points.filename().string();
  scenario.world.landmarks_file = beside(rawlog, ".landmarks.csv").filename().string();
  const fs::path walls = beside(rawlog, ".walls.csv");
  fs::remove(walls);  // of an earlier drive
  if (!world.walls.empty()) {
    replace_file(walls, walls_text(world));
    scenario.world.walls_file = walls.filename().string();
  }
  return scenario;
}

nlohmann::ordered_json notes_of(Scenario scenario, const DriveSummary& summary) {
  nlohmann::ordered_json notes;
  notes["program"] = "slam-simulate";
  notes["version"] = version();
  notes["git"] = git_revision();
  notes["seed"] = scenario.seed;
  notes["steps"] = summary.steps;
  notes["observations"] = summary.observations;
  notes["duration_s"] = summary.duration_s;
  notes["distance_m"] = summary.distance_m;
  for (const ParameterEntry& entry : list_parameters(ParameterTable(scenario)))
    notes["scenario"][entry.name] = entry.value;
  return notes;
}

/// Tags have corners, which are landmarks too. A world that was read back knows them already.
std::vector<TrueLandmark> true_landmarks(const Scenario& scenario, const World& world) {
  std::vector<TrueLandmark> landmarks = world.landmarks;
  if (!scenario.stereo_images.enabled) return landmarks;
  for (const TrueLandmark& corner : tag_corners(world, scenario.stereo_images.tag_size)) {
    const auto known = std::ranges::find(landmarks, corner.id, &TrueLandmark::id);
    if (known == landmarks.end()) landmarks.push_back(corner);
  }
  return landmarks;
}

}  // namespace

DriveSummary simulate_drive(const DriveRequest& request) {
  const auto simulator =
      make_simulator(request.scenario, static_cast<std::uint64_t>(request.scenario.seed));
  const LogParameters& log = request.scenario.log;
  SimulatedLogWriter writer(
      request.rawlog,
      log.flavour == "observations" ? LogFlavour::kObservations : LogFlavour::kPairs,
      log.odometry == "ticks");
  DriveSummary summary;
  Eigen::Vector2d last = simulator->start().head<2>();
  std::exception_ptr failure;
  double first_time = 0.0;
  try {
    while (auto simulated = simulator->next()) {
      writer.add(simulated->step, simulated->T_world_robot);
      if (simulated->step.index == 0) first_time = simulated->step.time;
      summary.duration_s = simulated->step.time - first_time;
      summary.distance_m += (simulated->T_world_robot.head<2>() - last).norm();
      last = simulated->T_world_robot.head<2>();
      if (request.on_step) request.on_step(simulator->progress());
      if (request.stop != nullptr && request.stop->load()) {
        summary.exit_code = 7;
        break;
      }
    }
  } catch (...) {
    failure = std::current_exception();
  }
  summary.steps = writer.steps();
  summary.observations = writer.observations();
  const Scenario portable = make_portable(request.scenario, simulator->world(), request.rawlog);
  writer.finish(true_landmarks(portable, simulator->world()), simulator->calibration(),
                notes_of(portable, summary));
  Scenario effective = portable;
  replace_file(beside(request.rawlog, ".scenario.yaml"), to_yaml(ParameterTable(effective)));
  replace_file(beside(request.rawlog, ".filter.yaml"), to_yaml(nominal_filter(effective)));
  if (failure) std::rethrow_exception(failure);
  return summary;
}

}  // namespace libslam
