// slam-import: a data set in its own format in, a standard MRPT rawlog and its ground truth out.

#include <atomic>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <libslam/config/version.hpp>
#include <libslam/io/importers/censi.hpp>
#include <libslam/io/importers/csv_log.hpp>
#include <libslam/io/importers/imported_log.hpp>
#include <libslam/io/importers/lost_in_the_woods.hpp>
#include <libslam/io/importers/mrclam.hpp>
#include <libslam/io/importers/victoria_park.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/input_file.hpp>

namespace {

using namespace libslam;
using Association = VictoriaParkOptions::Association;
using Steering = VictoriaParkOptions::Steering;

enum ExitCode { kDone = 0, kCommandLine = 2, kInput = 4, kInterrupted = 7 };

constexpr double kRadiansPerDegree = M_PI / 180.0;

volatile std::sig_atomic_t g_stop = 0;

struct Arguments {
  std::string out, directory;
  std::vector<std::string> distortions;
  std::vector<double> sensor_pose{0.0, 0.0, 0.0}, metres_per_tick{0.001, 0.001};
  double track = 0.5;
  int robot = 1;
  bool strip_ids = false, quiet = false, verbose = false;
  Association association = Association::kNone;
  Steering steering = Steering::kAa3;
  double max_diameter = 2.0;
  CsvLogOptions csv;
  CensiOptions censi;
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

ImportedLog load_victoria_park(const Arguments& arguments) {
  VictoriaParkOptions options;
  options.association = arguments.association;
  options.steering = arguments.steering;
  options.max_diameter = arguments.max_diameter;
  if (options.association == Association::kIsam) {
    ImportedLog log = import_victoria_park(arguments.directory, options);
    distort_odometry(arguments, log);
    return log;
  }
  const Distortions values =
      parse_distortions(arguments.distortions, {"speed", "steering", "bias_deg"});
  options.distortion = {value_or(values, "speed", 1.0), value_or(values, "steering", 1.0),
                        kRadiansPerDegree * value_or(values, "bias_deg", 0.0)};
  return import_victoria_park(arguments.directory, options);
}

ImportedLog load_csv(Arguments arguments) {
  CsvLogOptions& csv = arguments.csv;
  if (!arguments.directory.empty()) {
    if (csv.odometry.empty()) csv.odometry = find_input_file(arguments.directory, "odometry.csv");
    if (csv.landmarks.empty())
      csv.landmarks = find_input_file(arguments.directory, "landmarks.csv");
    if (csv.truth.empty()) csv.truth = find_optional_input_file(arguments.directory, "truth.csv");
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

ImportedLog load_censi(const Arguments& arguments) {
  if (!arguments.distortions.empty())
    throw std::invalid_argument(
        "--distort: choose another --nominal-radius or --nominal-track instead");
  return import_censi(arguments.directory, arguments.censi);
}

void report(const Arguments& arguments, const ImportedLog& log) {
  if (arguments.quiet) return;
  std::size_t sightings = 0;
  for (const auto& scan : log.scans) sightings += scan.sightings.size();
  std::cout << arguments.out << ": " << log.scenario << ", " << log.odometry.size()
            << " odometry readings, " << log.sensor_path.size() << " sensor poses, "
            << log.scans.size() << " scans with " << sightings << " landmark sightings, "
            << log.truth.path.poses.size() << " true poses, " << log.truth.landmarks.size()
            << " true landmarks\n";
  if (!arguments.verbose) return;
  for (const auto& [name, value] : log.parameters)
    std::cout << "  " << name << " = " << value << '\n';
  for (const auto& [name, text] : log.remarks) std::cout << "  " << name << ": " << text << '\n';
}

int import(const Arguments& arguments, const CLI::App& app) {
  ImportedLog log;
  if (app.got_subcommand("mrclam")) {
    log = import_mrclam(arguments.directory, arguments.robot);
    distort_odometry(arguments, log);
  } else if (app.got_subcommand("lost-in-the-woods")) {
    log = import_lost_in_the_woods(arguments.directory);
    distort_odometry(arguments, log);
  } else if (app.got_subcommand("victoria-park")) {
    log = load_victoria_park(arguments);
  } else if (app.got_subcommand("censi")) {
    log = load_censi(arguments);
  } else {
    log = load_csv(arguments);
  }
  if (arguments.strip_ids) strip_identities(log);
  const bool complete = write_imported_log(log, arguments.out, [] { return g_stop != 0; });
  report(arguments, log);
  return complete ? kDone : kInterrupted;
}

CLI::App* add_data_set(CLI::App& app, Arguments& arguments, const std::string& name,
                       const std::string& text, bool directory_required = true) {
  CLI::App* sub = app.add_subcommand(name, text);
  sub->add_option("directory", arguments.directory, "Directory of the data set")
      ->required(directory_required);
  sub->add_option("--out", arguments.out, "Rawlog to write; the truth goes beside it")
      ->required()
      ->check([](const std::string& file) {
        return std::filesystem::path(file).extension() == ".rawlog" ? "" : "must end in .rawlog";
      });
  sub->add_flag("--strip-ids", arguments.strip_ids, "Remove the identities of the landmarks");
  sub->add_option(
         "--distort", arguments.distortions,
         "Falsify the odometry: left=F,right=F (wheel travel through the virtual track), or for "
         "victoria-park speed=F,steering=F,bias_deg=D")
      ->delimiter(',');
  sub->add_option("--track", arguments.track,
                  "Virtual track of --distort [m]; with ticks the real one")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  sub->add_flag("--quiet", arguments.quiet, "Print errors only");
  sub->add_flag("--verbose", arguments.verbose, "Print parameters and remarks of the data set");
  return sub;
}

void add_commands(CLI::App& app, Arguments& arguments) {
  auto* mrclam = add_data_set(app, arguments, "mrclam", "UTIAS MRCLAM data set");
  mrclam->add_option("--robot", arguments.robot, "Number of the robot")
      ->required()
      ->check(CLI::Range(1, 5));
  add_data_set(app, arguments, "lost-in-the-woods", "UTIAS Lost in the Woods");
  auto* park = add_data_set(app, arguments, "victoria-park", "Victoria Park, Sydney");
  park->add_option("--association", arguments.association,
                   "none: tree detections; known: identified trees; isam: relative odometry and "
                   "landmarks with covariances, as pairs")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Association>{{"none", Association::kNone},
                                             {"known", Association::kKnown},
                                             {"isam", Association::kIsam}}));
  park->add_option("--steering", arguments.steering, "Published steering calibration: aa3 or drs")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Steering>{{"aa3", Steering::kAa3}, {"drs", Steering::kDrs}}));
  park->add_option("--max-diameter", arguments.max_diameter, "Leave out thicker trunks [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  auto* censi = add_data_set(app, arguments, "censi", "Odometry calibration of Censi et al.");
  censi
      ->add_option("--subset", arguments.censi.subset,
                   "Mounting of the laser: lstraight, l90 or lmov; with _0, _1, _2 a third of it")
      ->required();
  censi
      ->add_option("--nominal-radius", arguments.censi.nominal_radius,
                   "Radius of both wheels that the odometry is computed with [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  censi
      ->add_option("--nominal-track", arguments.censi.nominal_track,
                   "Track width that the odometry is computed with [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  auto* csv = add_data_set(app, arguments, "csv", "CSV files of one's own", false);
  csv->footer(
      "The first row of a file names its columns:\n"
      "  odometry.csv   t,x,y,phi | t,v,omega | t,left_ticks,right_ticks\n"
      "  landmarks.csv  t,id,range,bearing[,sigma_range,sigma_bearing]   (id -1: unknown)\n"
      "  truth.csv      t,x,y[,phi]   (optional)\n"
      "in s, m and rad; v and omega are means since the row before; ticks are absolute counters.");
  csv->add_option("--odometry", arguments.csv.odometry, "File instead of odometry.csv");
  csv->add_option("--landmarks", arguments.csv.landmarks, "File instead of landmarks.csv");
  csv->add_option("--truth", arguments.csv.truth, "File instead of truth.csv");
  csv->add_option("--sensor-pose", arguments.sensor_pose, "Sensor on the robot: x y phi [m m deg]")
      ->expected(3);
  csv->add_option("--metres-per-tick", arguments.metres_per_tick,
                  "Of both wheels, or left and right")
      ->expected(1, 2)
      ->check(CLI::PositiveNumber);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Converts a public data set, or CSV files, to an MRPT rawlog with ground truth."};
  app.set_version_flag("--version", "slam-import " + std::string(version()) + " (" +
                                        std::string(git_revision()) + ")");
  app.require_subcommand(1);
  app.footer(
      "Example:\n  slam-import mrclam MRCLAM_Dataset6 --robot 1 --out mrclam6_r1.rawlog\n"
      "Writes X.rawlog, X.truth.json and, where known, X.truth.tum and X.landmarks.csv.");
  add_commands(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kCommandLine;
  }
  std::signal(SIGINT, [](int) { g_stop = 1; });
  std::signal(SIGTERM, [](int) { g_stop = 1; });
  try {
    return import(arguments, app);
  } catch (const InputError& error) {
    std::cerr << "slam-import: " << error.what() << '\n';
    return kInput;
  } catch (const std::exception& error) {
    std::cerr << "slam-import: " << error.what() << '\n';
    return kCommandLine;
  }
}
