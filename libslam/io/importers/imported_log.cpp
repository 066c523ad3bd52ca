#include <cmath>
#include <stdexcept>

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>
#include <nlohmann/json.hpp>

#include <libslam/io/arc_motion.hpp>
#include <libslam/io/importers/imported_log.hpp>
#include <libslam/io/truth_writer.hpp>
#include <libslam/map/csv_text.hpp>

namespace libslam {
namespace {

using mrpt::obs::CObservationBearingRange;

mrpt::poses::CPose2D to_pose(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

CObservationBearingRange::TMeasurement to_measurement(const ImportedSighting& sighting) {
  CObservationBearingRange::TMeasurement m{};
  m.range = static_cast<float>(sighting.range);
  m.yaw = static_cast<float>(sighting.bearing);
  m.landmarkID = static_cast<std::int32_t>(sighting.id);
  if (sighting.cov) {
    m.covariance(0, 0) = (*sighting.cov)(0, 0);
    m.covariance(0, 1) = m.covariance(1, 0) = (*sighting.cov)(0, 1);
    m.covariance(1, 1) = (*sighting.cov)(1, 1);
  }
  return m;
}

/// Writes one log; keeps the odometry pose.
class RawlogWriter {
 public:
  RawlogWriter(const ImportedLog& log, const std::string& file) : log_(log) {
    if (!out_.open(file)) throw std::runtime_error(file + ": cannot be written");
  }

  void write_odometry(const ImportedOdometry& reading) {
    pose_ = pose_ + to_pose(increment_of_arc(reading.arc));
    mrpt::obs::CObservationOdometry o;
    o.timestamp = mrpt::Clock::fromDouble(reading.time);
    o.sensorLabel = "odometry";
    o.odometry = pose_;
    fill_measured(reading, o);
    if (reading.ticks) {
      o.encoderLeftTicks = (*reading.ticks)[0];
      o.encoderRightTicks = (*reading.ticks)[1];
    }
    archive() << o;
  }

  void write_scan(const ImportedScan& scan) { archive() << to_observation(scan); }

  void write_laser_scan(const ImportedLaserScan& scan) {
    archive() << to_range_scan(log_.laser, scan.time, scan.ranges);
  }

  void write_frame(const ImportedScan& scan) {
    mrpt::obs::CSensoryFrame frame;
    if (!log_.scans.empty())
      frame.insert(std::make_shared<CObservationBearingRange>(to_observation(scan)));
    const bool placed = on_path_ < log_.sensor_path.size();
    if (placed && log_.sensor_path[on_path_].time == scan.time)
      frame.insert(to_observation(log_.sensor_path[on_path_++]));
    archive() << frame;
  }

  void write_action(const ImportedOdometry& reading) {
    mrpt::obs::CActionRobotMovement2D motion;
    motion.timestamp = mrpt::Clock::fromDouble(reading.time);
    motion.rawOdometryIncrementReading = to_pose(increment_of_arc(reading.arc));
    mrpt::math::CMatrixDouble33 cov;
    for (int i = 0; reading.cov_increment && i < 3; ++i)
      for (int j = 0; j < 3; ++j) cov(i, j) = (*reading.cov_increment)(i, j);
    motion.poseChange =
        mrpt::poses::CPosePDFGaussian::Create(motion.rawOdometryIncrementReading, cov);
    // MRPT recomputes poseChange from its own motion model when it reads an action of method
    // odometry.
    motion.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
    fill_measured(reading, motion);
    mrpt::obs::CActionCollection actions;
    actions.insert(motion);
    archive() << actions;
  }

 private:
  mrpt::serialization::CArchive& archive() { return *archive_; }

  void fill_measured(const ImportedOdometry& reading, auto& out) const {
    out.hasEncodersInfo = reading.ticks.has_value();
    out.hasVelocities = reading.has_velocity && reading.dt > 0.0;
    if (!out.hasVelocities) return;
    const Eigen::Vector3d velocity = reading.arc / reading.dt;
    out.velocityLocal = {velocity.x(), velocity.y(), velocity.z()};
  }

  CObservationBearingRange to_observation(const ImportedScan& scan) const {
    CObservationBearingRange o;
    o.timestamp = mrpt::Clock::fromDouble(scan.time);
    o.sensorLabel = "landmarks";
    o.sensorLocationOnRobot = mrpt::poses::CPose3D(to_pose(log_.T_robot_sensor));
    o.fieldOfView_yaw = static_cast<float>(log_.field_of_view);
    o.fieldOfView_pitch = 0.0F;
    o.maxSensorDistance = static_cast<float>(log_.max_range);
    o.sensor_std_range = static_cast<float>(log_.sigma_range);
    o.sensor_std_yaw = static_cast<float>(log_.sigma_bearing);
    for (const auto& sighting : scan.sightings) o.sensedData.push_back(to_measurement(sighting));
    o.validCovariances = !scan.sightings.empty();
    for (const auto& sighting : scan.sightings) o.validCovariances &= sighting.cov.has_value();
    return o;
  }

  static mrpt::obs::CObservationOdometry::Ptr to_observation(const ImportedSensorPose& reading) {
    auto o = mrpt::obs::CObservationOdometry::Create();
    o->timestamp = mrpt::Clock::fromDouble(reading.time);
    o->sensorLabel = "scan_matching";
    o->odometry = to_pose(reading.pose);
    return o;
  }

  const ImportedLog& log_;
  std::size_t on_path_ = 0;  // first reading of the sensor path that is not written
  mrpt::io::CFileGZOutputStream out_;
  mrpt::serialization::CArchive::UniquePtr archive_ =
      mrpt::serialization::archiveUniquePtrFrom(out_);
  mrpt::poses::CPose2D pose_;
};

bool write_rawlog(const ImportedLog& log, const std::string& file,
                  const std::function<bool()>& interrupted) {
  RawlogWriter writer(log, file);
  auto scan = log.scans.begin();
  auto laser_scan = log.laser_scans.begin();
  bool first = true;
  for (const auto& reading : log.odometry) {
    if (interrupted && interrupted()) return false;
    for (; scan != log.scans.end() && scan->time < reading.time; ++scan)
      log.as_pairs ? writer.write_frame(*scan) : writer.write_scan(*scan);
    for (; laser_scan != log.laser_scans.end() && laser_scan->time < reading.time; ++laser_scan)
      writer.write_laser_scan(*laser_scan);
    if (!log.as_pairs)
      writer.write_odometry(reading);
    else if (!first)
      writer.write_action(reading);
    const bool seen = scan != log.scans.end() && scan->time == reading.time;
    if (log.as_pairs) writer.write_frame(seen ? *scan++ : ImportedScan{reading.time, {}});
    first = false;
  }
  for (; scan != log.scans.end(); ++scan)
    log.as_pairs ? writer.write_frame(*scan) : writer.write_scan(*scan);
  for (; laser_scan != log.laser_scans.end(); ++laser_scan) writer.write_laser_scan(*laser_scan);
  return true;
}

std::string notes_text(const ImportedLog& log) {
  nlohmann::json json;
  json["scenario"] = log.scenario;
  json["has_heading"] = log.truth.path.has_heading;
  const auto& point = log.truth.path.point_on_robot;
  if (!log.truth.path.has_heading) json["point_on_robot"] = {point.x(), point.y()};
  json["calibration"] = log.truth.calibration;
  json["parameters"] = log.parameters;
  json["remarks"] = log.remarks;
  return json.dump(2) + "\n";
}

}  // namespace

void ImportedLog::add_sighting(const TextReader& row, double time, ImportedSighting sighting) {
  if (!(sighting.range > 0.0)) row.reject("range must be positive");
  if (sighting.id < kNoIdentity || sighting.id > INT32_MAX) row.reject("landmark id out of range");
  if (!scans.empty() && time < scans.back().time) row.reject("time goes backwards");
  sighting.bearing = std::remainder(sighting.bearing, 2.0 * M_PI);
  if (scans.empty() || time > scans.back().time) scans.push_back({time, {}});
  scans.back().sightings.push_back(std::move(sighting));
}

void ImportedLog::add_laser_scan(const TextReader& row, double time, std::size_t first,
                                 double unit) {
  constexpr std::size_t kMostBeams = 10000;
  row.require_columns(first + 2);
  const std::size_t count = row.columns() - first;
  if (count > kMostBeams) row.reject("more than 10000 ranges");
  if (!laser_scans.empty() && time <= laser_scans.back().time) row.reject("time does not increase");
  if (!laser_scans.empty() && count != laser_scans.front().ranges.size())
    row.reject("another number of ranges than in the first scan");
  ImportedLaserScan& scan = laser_scans.emplace_back();
  scan.time = time;
  scan.ranges.reserve(count);
  for (std::size_t i = first; i < row.columns(); ++i)
    scan.ranges.push_back(static_cast<float>(unit * row.number(i)));
}

void ImportedLog::add_ticks(const TextReader& row, double time, std::array<std::size_t, 2> columns,
                            const Eigen::Vector2d& metres_per_tick, double track) {
  const auto last = odometry.empty() ? std::nullopt : odometry.back().ticks;
  add_velocity(row, time, Eigen::Vector3d::Zero());
  ImportedOdometry& reading = odometry.back();
  reading.has_velocity = false;
  reading.ticks.emplace();
  Eigen::Vector2d travel = Eigen::Vector2d::Zero();
  for (std::size_t wheel = 0; wheel < 2; ++wheel) {
    const std::int64_t count = row.integer(columns[wheel]);
    if (count < INT32_MIN || count > INT32_MAX) row.reject("encoder counter beyond 32 bits");
    (*reading.ticks)[wheel] = static_cast<std::int32_t>(count);
    const auto i = static_cast<Eigen::Index>(wheel);
    if (last) travel[i] = metres_per_tick[i] * static_cast<double>(count - (*last)[wheel]);
  }
  reading.arc = {travel.mean(), 0.0, (travel[1] - travel[0]) / track};
}

void ImportedLog::add_velocity(const TextReader& row, double time,
                               const Eigen::Vector3d& velocity) {
  ImportedOdometry reading;
  reading.time = time;
  reading.dt = odometry.empty() ? 0.0 : time - odometry.back().time;
  if (reading.dt < 0.0) row.reject("time goes backwards");
  reading.arc = velocity * reading.dt;
  odometry.push_back(reading);
}

void distort_wheels(ImportedLog& log, double left, double right, double track) {
  const auto scaled = [](std::int32_t ticks, double factor) {
    return static_cast<std::int32_t>(std::llround(factor * ticks));
  };
  for (auto& reading : log.odometry) {
    const double dl = left * (reading.arc.x() - reading.arc.z() * track / 2);
    const double dr = right * (reading.arc.x() + reading.arc.z() * track / 2);
    reading.arc.x() = (dl + dr) / 2;
    reading.arc.z() = (dr - dl) / track;
    if (reading.ticks)
      reading.ticks = {scaled((*reading.ticks)[0], left), scaled((*reading.ticks)[1], right)};
  }
  log.parameters["distortion_left"] = left;
  log.parameters["distortion_right"] = right;
  log.parameters["distortion_track_width"] = track;
}

void strip_identities(ImportedLog& log) {
  for (auto& scan : log.scans)
    for (auto& sighting : scan.sightings) sighting.id = kNoIdentity;
  log.remarks["identities"] = "removed from the sightings at import";
}

bool write_imported_log(const ImportedLog& log, const std::string& rawlog,
                        const std::function<bool()>& interrupted) {
  remove_truth_beside(rawlog);
  const bool complete = write_rawlog(log, rawlog, interrupted);
  write_truth_beside(rawlog, log.truth, notes_text(log));
  return complete;
}

}  // namespace libslam
