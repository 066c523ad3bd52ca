#pragma once
// A data set in memory, the same for every source, and how it becomes a standard MRPT rawlog.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <libslam/data/feature.hpp>
#include <libslam/data/ground_truth.hpp>
#include <libslam/io/importers/laser_scan.hpp>
#include <libslam/io/text_reader.hpp>

namespace libslam {

/// One odometry reading of a data set.
struct ImportedOdometry {
  double time = 0.0;  ///< [s]
  double dt = 0.0;    ///< since the reading before [s]
  /// Mean body velocity times dt: forward [m], sideways [m], turn [rad]; zero for the first
  /// reading.
  Eigen::Vector3d arc = Eigen::Vector3d::Zero();
  bool has_velocity = true;  ///< arc / dt is a velocity that the source gave
  std::optional<std::array<std::int32_t, 2>> ticks;  ///< absolute counters left, right
  std::optional<Eigen::Matrix3d> cov_increment;      ///< of the pose change (pair logs)
};

struct ImportedSighting {
  std::int64_t id = kNoIdentity;
  double range = 0.0;                  ///< [m]
  double bearing = 0.0;                ///< [rad], sensor frame, left positive
  std::optional<Eigen::Matrix2d> cov;  ///< of (range, bearing)
};

/// What the sensor saw at one time.
struct ImportedScan {
  double time = 0.0;  ///< [s]
  std::vector<ImportedSighting> sightings;
};

/// The raw ranges of a laser at one time, counter-clockwise [m].
struct ImportedLaserScan {
  double time = 0.0;  ///< [s]
  std::vector<float> ranges;
};

/// Where a sensor says it is, on its own path (scan matching, visual odometry).
struct ImportedSensorPose {
  double time = 0.0;                               ///< [s]
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< x [m], y [m], phi [rad]
};

struct ImportedLog {
  std::string scenario;                        ///< name of the data set and sequence
  std::vector<ImportedOdometry> odometry;      ///< times never decrease
  std::vector<ImportedScan> scans;             ///< times increase
  std::vector<ImportedLaserScan> laser_scans;  ///< times increase; not in pair logs
  LaserGeometry laser;                         ///< of the laser scans
  /// At times of odometry readings (pair logs); written as odometry of the sensor "scan_matching".
  std::vector<ImportedSensorPose> sensor_path;
  Eigen::Vector3d T_robot_sensor = Eigen::Vector3d::Zero();  ///< x [m], y [m], phi [rad]
  double sigma_range = 0.0;                                  ///< [m], 0 if the source states none
  double sigma_bearing = 0.0;                                ///< [rad], 0 if the source states none
  double field_of_view = 2.0 * 3.141592653589793;            ///< [rad]
  double max_range = 0.0;                                    ///< [m], 0 if the source states none
  bool as_pairs = false;  ///< write (action, frame) pairs instead of observations
  GroundTruth truth;
  std::map<std::string, double>
      parameters;  ///< of the vehicle and of the falsification, for the notes
  std::map<std::string, std::string> remarks;  ///< what a reader of the truth must know

  /// Adds a sighting at `time` to the last scan, or to a new one if time has moved on. Rejects the
  /// row if time goes backwards or the range is not positive; wraps the bearing.
  void add_sighting(const TextReader& row, double time, ImportedSighting sighting);
  /// Adds the ranges from column `first` to the end of the row [`unit` m]. Rejects the row if time
  /// does not increase or it holds another number of ranges than the first.
  void add_laser_scan(const TextReader& row, double time, std::size_t first, double unit = 1.0);
  /// Adds a reading of the absolute tick counters in two columns, of a differential drive with
  /// nominal travel per tick (left, right) [m] and track [m]. Rejects the row if time goes
  /// backwards or a counter is beyond 32 bits.
  void add_ticks(const TextReader& row, double time, std::array<std::size_t, 2> columns,
                 const Eigen::Vector2d& metres_per_tick, double track);
  /// Adds a reading that moved by `velocity` (forward, sideways, turn) since the reading before.
  /// Rejects the row if time goes backwards.
  void add_velocity(const TextReader& row, double time, const Eigen::Vector3d& velocity);
};

/// Multiplies the travel of the left and right wheel of a differential drive with the given track
/// [m]: dl = ds - dphi track/2 and dr = ds + dphi track/2. Ticks, where there are any, change with
/// them. Recorded in `parameters`.
void distort_wheels(ImportedLog& log, double left, double right, double track);

/// Removes the identities of all sightings.
void strip_identities(ImportedLog& log);

/// Writes `rawlog` (X.rawlog, compressed), X.truth.json and, where known, X.truth.tum and
/// X.landmarks.csv; such files of an earlier import are removed. Odometry poses start at the origin
/// and are integrated exactly along arcs. `interrupted` is asked for every entry; true ends the
/// rawlog there, complete as far as it goes. Returns false if that happened. Throws
/// std::runtime_error if a file cannot be written.
bool write_imported_log(const ImportedLog& log, const std::string& rawlog,
                        const std::function<bool()>& interrupted = {});

}  // namespace libslam
