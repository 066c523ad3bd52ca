#include <cmath>
#include <deque>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/serialization/CArchive.h>
#include <nlohmann/json.hpp>

#include <libslam/io/importers/carmen.hpp>
#include <libslam/io/importers/carmen_messages.hpp>
#include <libslam/io/importers/mended_clock.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/truth_reader.hpp>
#include <libslam/io/truth_writer.hpp>
#include <libslam/result/atomic_file.hpp>

namespace libslam {
namespace {

namespace fs = std::filesystem;

// Two poses of one message are printed with six decimals or less.
constexpr double kMountTolerance = 0.01, kMountTurnTolerance = 0.02;  ///< [m], [rad]

/// Scans of a corrected log, one ahead.
class Reference {
 public:
  Reference(const std::string& file, double max_range) : max_range_(max_range) {
    if (file.empty()) return;
    row_.emplace(file);
    advance();
  }

  /// Takes `scan`, if it is the one that comes next, as a pose at `time`.
  void offer(const CarmenMessage& scan, double time) {
    if (!next_ || !same_ranges(scan.ranges, next_->ranges)) return;
    path_.times.push_back(time);
    path_.poses.push_back(next_->robot);
    advance();
  }

  void finish() const {
    if (next_)
      throw InputError(row_->file() + ":" + std::to_string(next_->line) +
                       ": this scan is not in the log, or not in this order");
    if (row_ && path_.poses.empty()) throw InputError(row_->file() + ": holds no scans");
  }

  const Trajectory& path() const { return path_; }

 private:
  void advance() {
    do {
      next_.reset();
      if (!row_->next()) return;
      next_ = read_carmen_message(*row_, max_range_);
    } while (!next_ || !next_->is_scan());
  }

  /// As printed, with two decimals or more.
  static bool same_ranges(const std::vector<float>& a, const std::vector<float>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (std::abs(a[i] - b[i]) > 0.002F) return false;
    return true;
  }

  double max_range_;
  std::optional<TextReader> row_;
  std::optional<CarmenMessage> next_;
  Trajectory path_;
};

/// One import.
class Import {
 public:
  Import(const std::string& log, const CarmenOptions& options)
      : log_(log), options_(options), row_(log), reference_(options.reference, options.max_range) {}

  /// Writes the rawlog `file`; false if it cannot be written.
  bool write(const std::string& file, const std::function<bool()>& interrupted) {
    mrpt::io::CFileGZOutputStream out;
    if (!out.open(file)) return false;
    auto archive = mrpt::serialization::archiveUniquePtrFrom(out);
    while (row_.next()) {
      if (interrupted && interrupted()) {
        summary_.complete = false;
        break;
      }
      if (take_row()) write_settled(*archive, false);
    }
    write_settled(*archive, true);
    if (summary_.complete) check_end();
    return true;
  }

  const CarmenSummary& summary() const { return summary_; }
  const Reference& reference() const { return reference_; }

  std::string notes_text() const {
    nlohmann::ordered_json notes;
    notes["scenario"] = "CARMEN log " + fs::path(log_).filename().string();
    notes["has_heading"] = true;
    notes["calibration"] = nlohmann::json::object();
    notes["parameters"] = {{"max_range", options_.max_range}};
    notes["remarks"] = nlohmann::json::object();
    if (!reference_.path().poses.empty())
      notes["remarks"]["path"] =
          "a reference, not ground truth: poses that a mapper computed from the same scans";
    notes["mended_times"] = mended_times_;
    return notes.dump(2) + "\n";
  }

 private:
  /// Whether the row is one of the messages that are written.
  bool take_row() {
    auto message = read_carmen_message(row_, options_.max_range);
    const bool messages = options_.odometry == CarmenOptions::Odometry::kMessages;
    if (!message || (!message->is_scan() && !messages)) {
      ++summary_.left_out[std::string(row_.word(0).substr(0, kLongestName))];
      if (summary_.left_out.size() > kMostKinds) row_.reject("this is no CARMEN log");
      return false;
    }
    if (message->is_scan()) check_mount(message->laser);
    if (!clock_.push(message->time))
      row_.reject("the time stamp goes back by more than late stamps explain");
    waiting_.push_back(std::move(*message));
    return true;
  }

  void check_mount(const LaserGeometry& laser) {
    if (!mount_) mount_ = laser.T_robot_sensor;
    const Eigen::Vector3d moved = laser.T_robot_sensor - *mount_;
    if (moved.head<2>().norm() > kMountTolerance ||
        std::abs(std::remainder(moved.z(), 2.0 * M_PI)) > kMountTurnTolerance)
      row_.reject("the laser has moved on the robot: one of its two poses is not odometry");
  }

  void write_settled(mrpt::serialization::CArchive& archive, bool at_end) {
    while (const auto time = clock_.pop(at_end)) {
      const CarmenMessage message = std::move(waiting_.front());
      waiting_.pop_front();
      if (*time != message.time) {
        ++summary_.mended_times;
        if (message.is_scan()) mended_times_.emplace_back(message.time, *time);
      }
      const bool messages = options_.odometry == CarmenOptions::Odometry::kMessages;
      if (message.is_scan() != messages) write_odometry(archive, message.robot, *time);
      if (message.is_scan()) write_scan(archive, message, *time);
    }
  }

  void write_odometry(mrpt::serialization::CArchive& archive, const Eigen::Vector3d& pose,
                      double time) {
    mrpt::obs::CObservationOdometry odometry;
    odometry.timestamp = mrpt::Clock::fromDouble(time);
    odometry.sensorLabel = "odometry";
    odometry.odometry = {pose.x(), pose.y(), pose.z()};
    archive << odometry;
    ++summary_.odometry;
  }

  void write_scan(mrpt::serialization::CArchive& archive, const CarmenMessage& scan, double time) {
    LaserGeometry laser = scan.laser;
    laser.T_robot_sensor = *mount_;
    archive << to_range_scan(laser, time, scan.ranges);
    ++summary_.scans;
    reference_.offer(scan, time);
  }

  void check_end() const {
    if (summary_.scans == 0) throw InputError(log_ + ": holds no scans (FLASER, ROBOTLASER1)");
    if (summary_.odometry == 0) throw InputError(log_ + ": holds no odometry (ODOM)");
    reference_.finish();
  }

  static constexpr std::size_t kLongestName = 32, kMostKinds = 100;

  std::string log_;
  const CarmenOptions& options_;
  TextReader row_;
  Reference reference_;
  CarmenSummary summary_;
  MendedClock clock_;
  std::deque<CarmenMessage> waiting_;  // for their times
  std::optional<Eigen::Vector3d> mount_;
  std::vector<std::pair<double, double>> mended_times_;
};

/// X.relations beside X.clf[.gz], or nothing.
std::string relations_beside(const std::string& log) {
  fs::path file(log);
  if (file.extension() == ".gz") file.replace_extension();
  file.replace_extension(".relations");
  std::error_code ignored;
  return fs::is_regular_file(file, ignored) ? file.string() : std::string();
}

}  // namespace

CarmenSummary import_carmen(const std::string& log, const std::string& rawlog,
                            const CarmenOptions& options,
                            const std::function<bool()>& interrupted) {
  GroundTruth truth;
  const std::string relations =
      options.relations.empty() ? relations_beside(log) : options.relations;
  if (!relations.empty()) truth.relations = read_relations(relations);
  Import import(log, options);
  replace_file(rawlog,
               [&](const fs::path& file) { return import.write(file.string(), interrupted); });
  truth.path = import.reference().path();
  remove_truth_beside(rawlog);
  write_truth_beside(rawlog, truth, import.notes_text());
  CarmenSummary summary = import.summary();
  summary.relations = static_cast<std::int64_t>(truth.relations.size());
  summary.reference_poses = static_cast<std::int64_t>(truth.path.poses.size());
  return summary;
}

}  // namespace libslam
