#include <algorithm>

#include <libslam/io/importers/brenner.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/input_file.hpp>

namespace libslam {
namespace {

constexpr double kMilli = 1e-3;  ///< the data set is in mm and ms
constexpr double kLaserAhead = 0.03, kMaxRange = 4.0;
// Beam i of 660 looks along (i - 330) * kResolution - kMountAngle.
constexpr std::size_t kBeams = 660;
constexpr double kResolution = 0.006135923151543, kMountAngle = 0.06981317;

/// Opens a file of rows that begin with `mark`.
class MarkedRows {
 public:
  /// `shift` [s] is added to the times.
  MarkedRows(const std::string& directory, const std::string& name, const char* mark, double shift)
      : row_(find_input_file(directory, name)), mark_(mark), shift_(shift) {}

  bool next() {
    if (!row_.next()) return false;
    if (row_.word(0) != mark_) row_.reject(std::string("a row begins with ") + mark_);
    return true;
  }
  const TextReader& row() const { return row_; }
  double time() const { return kMilli * row_.number(1) + shift_; }

 private:
  TextReader row_;
  std::string mark_;
  double shift_;
};

/// What brings the clocks together [s]; never to before the start, where no time stamp is.
struct ClockShifts {
  explicit ClockShifts(const BrennerOptions& options)
      : ticks(std::max({0.0, options.scan_delay, options.camera_delay})),
        scans(ticks - options.scan_delay),
        camera(ticks - options.camera_delay) {}
  double ticks, scans, camera;
};

void read_motors(const std::string& directory, const BrennerOptions& options, double shift,
                 ImportedLog& log) {
  MarkedRows rows(directory, "robot4_motors.txt", "M", shift);  // M t left . . . right . . .
  const Eigen::Vector2d metres_per_tick = Eigen::Vector2d::Constant(options.metres_per_tick);
  while (rows.next())
    log.add_ticks(rows.row(), rows.time(), {2, 6}, metres_per_tick, options.track_width);
  if (log.odometry.empty()) throw InputError(rows.row().file() + ": holds no readings");
}

void read_scans(const std::string& directory, double shift, ImportedLog& log) {
  log.laser.first_bearing = -kResolution * (kBeams / 2) - kMountAngle;
  log.laser.resolution = kResolution;
  log.laser.max_range = kMaxRange;
  log.laser.T_robot_sensor = log.T_robot_sensor;
  MarkedRows rows(directory, "robot4_scan.txt", "S", shift);  // S t 660 ranges
  while (rows.next()) {
    if (rows.row().integer(2) != kBeams || rows.row().columns() != kBeams + 3)
      rows.row().reject("a scan has 660 ranges");
    log.add_laser_scan(rows.row(), rows.time(), 3, kMilli);
  }
}

void read_truth(const std::string& directory, double shift, ImportedLog& log) {
  Trajectory& path = log.truth.path;
  path.has_heading = false;
  path.point_on_robot = {kLaserAhead, 0.0};
  MarkedRows positions(directory, "robot4_reference.txt", "P", shift);  // P t x y
  while (positions.next()) {
    const TextReader& row = positions.row();
    const double time = positions.time();
    if (!path.times.empty() && time < path.times.back()) row.reject("time goes backwards");
    path.times.push_back(time);
    path.poses.emplace_back(kMilli * row.number(2), kMilli * row.number(3), 0.0);
  }
  MarkedRows cylinders(directory, "robot_arena_landmarks.txt", "L", 0.0);  // L C x y diameter
  while (cylinders.next()) {
    const TextReader& row = cylinders.row();
    log.truth.landmarks.push_back(
        {static_cast<std::int64_t>(log.truth.landmarks.size()),
         Eigen::Vector2d(kMilli * row.number(2), kMilli * row.number(3))});
    log.parameters["cylinder_diameter"] = kMilli * row.number(4);
  }
}

}  // namespace

ImportedLog import_brenner(const std::string& directory, const BrennerOptions& options) {
  ImportedLog log;
  log.scenario = "LEGO robot of the SLAM lectures (Brenner)";
  log.T_robot_sensor = {kLaserAhead, 0.0, 0.0};
  const ClockShifts shift(options);
  read_motors(directory, options, shift.ticks, log);
  read_scans(directory, shift.scans, log);
  read_truth(directory, shift.camera, log);
  log.parameters["track_width"] = options.track_width;
  log.parameters["scan_delay"] = options.scan_delay;
  log.parameters["camera_delay"] = options.camera_delay;
  log.parameters["metres_per_tick"] = options.metres_per_tick;
  log.remarks["path"] = "overhead camera, positions of the laser; x and y of the arena, no heading";
  return log;
}

}  // namespace libslam
