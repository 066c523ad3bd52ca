#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <libslam/io/importers/brenner.hpp>
#include <libslam/io/importers/censi.hpp>
#include <libslam/io/importers/csv_log.hpp>
#include <libslam/io/importers/imported_log.hpp>
#include <libslam/io/importers/lost_in_the_woods.hpp>
#include <libslam/io/importers/mrclam.hpp>
#include <libslam/io/importers/victoria_park.hpp>
#include <libslam/io/input_file.hpp>

#include "command.hpp"

namespace {

using namespace libslam;
using Association = VictoriaParkOptions::Association;
using Steering = VictoriaParkOptions::Steering;

constexpr double kRadiansPerDegree = M_PI / 180.0;

/// Options of the data sets of this group.
struct Arguments {
  std::vector<std::string> distortions;
  std::vector<double> sensor_pose{0.0, 0.0, 0.0}, metres_per_tick{0.001, 0.001};
  double track = 0.5;
  int robot = 1;
  bool strip_ids = false;
  VictoriaParkOptions park;
  CsvLogOptions csv;
  CensiOptions censi;
  BrennerOptions brenner;
};

/// The factors of `--distort`, by name. Throws std::invalid_argument.
using Distortions = std::map<std::string, double>;

Distortions parse_distortions(const std::vector<std::string>& texts,
                              const std::vector<std::string>& allowed) {
  Distortions values;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    const std::string name = text.substr(0, equals);
    if (std::find(allowed.begin(), allowed.end(), name) == allowed.end())
      throw std::invalid_argument("--distort: '" + name + "' is not one of " +
                                  CLI::detail::join(allowed, ", ") + " for this data set");
    double value = 0.0;
    if (equals == std::string::npos || !CLI::detail::lexical_cast(text.substr(equals + 1), value) ||
        !std::isfinite(value) || (name != "bias_deg" && value <= 0.0))
      throw std::invalid_argument("--distort: '" + text +
                                  "' is no name=number with a positive factor");
    values[name] = value;
  }
  return values;
}

double value_or(const Distortions& values, const std::string& name, double otherwise) {
  const auto found = values.find(name);
  return found == values.end() ? otherwise : found->second;
}

/// Wheel factors through the virtual track, for data sets whose odometry is a body velocity.
void distort_odometry(const Arguments& arguments, ImportedLog& log) {
  const Distortions values = parse_distortions(arguments.distortions, {"left", "right"});
  if (values.empty()) return;
  distort_wheels(log, value_or(values, "left", 1.0), value_or(values, "right", 1.0),
                 arguments.track);
}

ImportedLog load_victoria_park(const std::string& directory, const Arguments& arguments) {
  VictoriaParkOptions options = arguments.park;
  if (options.association == Association::kIsam) {
    ImportedLog log = import_victoria_park(directory, options);
    distort_odometry(arguments, log);
    return log;
  }
  const Distortions values =
      parse_distortions(arguments.distortions, {"speed", "steering", "bias_deg"});
  options.distortion = {value_or(values, "speed", 1.0), value_or(values, "steering", 1.0),
                        kRadiansPerDegree * value_or(values, "bias_deg", 0.0)};
  return import_victoria_park(directory, options);
}

ImportedLog load_csv(const std::string& directory, const Arguments& arguments) {
  CsvLogOptions csv = arguments.csv;
  if (!directory.empty()) {
    if (csv.odometry.empty()) csv.odometry = find_input_file(directory, "odometry.csv");
    if (csv.landmarks.empty()) csv.landmarks = find_input_file(directory, "landmarks.csv");
    if (csv.truth.empty()) csv.truth = find_optional_input_file(directory, "truth.csv");
  }
  if (csv.odometry.empty() || csv.landmarks.empty())
    throw std::invalid_argument("csv: name a directory, or --odometry and --landmarks");
  csv.track_width = arguments.track;
  csv.metres_per_tick_left = arguments.metres_per_tick.front();
  csv.metres_per_tick_right = arguments.metres_per_tick.back();
  const auto& pose = arguments.sensor_pose;
  csv.T_robot_sensor = {pose[0], pose[1], kRadiansPerDegree * pose[2]};
  ImportedLog log = import_csv(csv);
  distort_odometry(arguments, log);
  return log;
}

ImportedLog load_censi(const std::string& directory, const Arguments& arguments) {
  if (!arguments.distortions.empty())
    throw std::invalid_argument(
        "--distort: choose another --nominal-radius or --nominal-track instead");
  return import_censi(directory, arguments.censi);
}

/// --track is the nominal one here; wheels are not distorted but by it.
ImportedLog load_brenner(const std::string& directory, const Arguments& arguments) {
  if (!arguments.distortions.empty())
    throw std::invalid_argument("--distort: choose another --nominal-track instead");
  return import_brenner(directory, arguments.brenner);
}

void report(const CommonArguments& arguments, const ImportedLog& log) {
  if (arguments.quiet) return;
  std::size_t sightings = 0;
  for (const auto& scan : log.scans) sightings += scan.sightings.size();
  std::cout << arguments.out << ": " << log.scenario << ", " << log.odometry.size()
            << " odometry readings, " << log.sensor_path.size() << " sensor poses, "
            << log.scans.size() << " scans with " << sightings << " landmark sightings, "
            << log.laser_scans.size() << " laser scans, " << log.truth.path.poses.size()
            << " true poses, " << log.truth.landmarks.size() << " true landmarks\n";
  print_notes(arguments, log.parameters, log.remarks);
}

/// Reads a data set into memory.
using Load = std::function<ImportedLog(const std::string& directory, const Arguments&)>;

/// The data sets of this group, as they are added.
class PlanarDataSets {
 public:
  PlanarDataSets(CLI::App& app, CommonArguments& common, Commands& commands)
      : app_(app), common_(common), commands_(commands) {}

  void add_mrclam();
  void add_lost_in_the_woods();
  void add_victoria_park();
  void add_censi();
  void add_brenner();
  void add_csv();

 private:
  CLI::App* add(const std::string& name, const std::string& text, Load load,
                const Source& source = {});

  CLI::App& app_;
  CommonArguments& common_;
  Commands& commands_;
  std::shared_ptr<Arguments> arguments_ = std::make_shared<Arguments>();
};

CLI::App* PlanarDataSets::add(const std::string& name, const std::string& text, Load load,
                              const Source& source) {
  auto* sub = add_subcommand(app_, common_, name, text, source);
  sub->add_flag("--strip-ids", arguments_->strip_ids, "Remove the identities of the landmarks");
  sub->add_option(
         "--distort", arguments_->distortions,
         "Falsify the odometry: left=F,right=F (wheel travel through the virtual track), or for "
         "victoria-park speed=F,steering=F,bias_deg=D")
      ->delimiter(',');
  sub->add_option("--track", arguments_->track,
                  "Virtual track of --distort [m]; with ticks the real one")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  commands_.push_back({sub, [arguments = arguments_, load = std::move(load)](
                                const CommonArguments& common, const Interrupted& interrupted) {
                         ImportedLog log = load(common.directory, *arguments);
                         if (arguments->strip_ids) strip_identities(log);
                         const bool complete = write_imported_log(log, common.out, interrupted);
                         report(common, log);
                         return complete;
                       }});
  return sub;
}

void PlanarDataSets::add_mrclam() {
  add("mrclam", "UTIAS MRCLAM data set",
      [](const std::string& directory, const Arguments& arguments) {
        ImportedLog log = import_mrclam(directory, arguments.robot);
        distort_odometry(arguments, log);
        return log;
      })
      ->add_option("--robot", arguments_->robot, "Number of the robot")
      ->required()
      ->check(CLI::Range(1, 5));
}

void PlanarDataSets::add_lost_in_the_woods() {
  add("lost-in-the-woods", "UTIAS Lost in the Woods",
      [](const std::string& directory, const Arguments& arguments) {
        ImportedLog log = import_lost_in_the_woods(directory);
        distort_odometry(arguments, log);
        return log;
      });
}

void PlanarDataSets::add_victoria_park() {
  auto* park = add("victoria-park", "Victoria Park, Sydney", load_victoria_park);
  park->add_option("--association", arguments_->park.association,
                   "none: tree detections; known: identified trees; isam: relative odometry and "
                   "landmarks with covariances, as pairs; raw_scans: no detections, but the scans "
                   "of the laser")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Association>{{"none", Association::kNone},
                                             {"known", Association::kKnown},
                                             {"isam", Association::kIsam},
                                             {"raw_scans", Association::kRawScans}}));
  park->add_option("--steering", arguments_->park.steering,
                   "Published steering calibration: aa3 or drs")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Steering>{{"aa3", Steering::kAa3}, {"drs", Steering::kDrs}}));
  park->add_option("--max-diameter", arguments_->park.max_diameter, "Leave out thicker trunks [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

void PlanarDataSets::add_censi() {
  auto* censi = add("censi", "Odometry calibration of Censi et al.", load_censi);
  censi
      ->add_option("--subset", arguments_->censi.subset,
                   "Mounting of the laser: lstraight, l90 or lmov; with _0, _1, _2 a third of it")
      ->required();
  censi
      ->add_option("--nominal-radius", arguments_->censi.nominal_radius,
                   "Radius of both wheels that the odometry is computed with [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  censi
      ->add_option("--nominal-track", arguments_->censi.nominal_track,
                   "Track width that the odometry is computed with [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

void PlanarDataSets::add_brenner() {
  auto* brenner = add("brenner", "LEGO robot with a laser, SLAM lectures", load_brenner);
  brenner
      ->add_option("--nominal-track", arguments_->brenner.track_width,
                   "Track width that the odometry poses are computed with [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  brenner
      ->add_option("--scan-delay", arguments_->brenner.scan_delay,
                   "Scans are stamped so much later than ticks [s]")
      ->check(CLI::Range(-5.0, 5.0))
      ->capture_default_str();
  brenner
      ->add_option("--camera-delay", arguments_->brenner.camera_delay,
                   "Reference positions are stamped so much later than ticks [s]")
      ->check(CLI::Range(-5.0, 5.0))
      ->capture_default_str();
}

void PlanarDataSets::add_csv() {
  auto* csv = add("csv", "CSV files of one's own", load_csv, {.required = false});
  csv->footer(
      "The first row of a file names its columns:\n"
      "  odometry.csv   t,x,y,phi | t,v,omega | t,left_ticks,right_ticks\n"
      "  landmarks.csv  t,id,range,bearing[,sigma_range,sigma_bearing]   (id -1: unknown)\n"
      "  truth.csv      t,x,y[,phi]   (optional)\n"
      "in s, m and rad; v and omega are means since the row before; ticks are absolute counters.");
  csv->add_option("--odometry", arguments_->csv.odometry, "File instead of odometry.csv");
  csv->add_option("--landmarks", arguments_->csv.landmarks, "File instead of landmarks.csv");
  csv->add_option("--truth", arguments_->csv.truth, "File instead of truth.csv");
  csv->add_option("--sensor-pose", arguments_->sensor_pose,
                  "Sensor on the robot: x y phi [m m deg]")
      ->expected(3);
  csv->add_option("--metres-per-tick", arguments_->metres_per_tick,
                  "Of both wheels, or left and right")
      ->expected(1, 2)
      ->check(CLI::PositiveNumber);
}

}  // namespace

void add_planar_data_sets(CLI::App& app, CommonArguments& arguments, Commands& commands) {
  PlanarDataSets sets(app, arguments, commands);
  sets.add_mrclam();
  sets.add_lost_in_the_woods();
  sets.add_victoria_park();
  sets.add_censi();
  sets.add_brenner();
  sets.add_csv();
}
