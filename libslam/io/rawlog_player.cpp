#include <cmath>
#include <filesystem>

#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <libslam/io/body_velocity.hpp>
#include <libslam/io/mrpt_fields.hpp>
#include <libslam/io/rawlog_player.hpp>

namespace libslam {
namespace {

using mrpt::obs::CObservation;
using mrpt::obs::CObservationBearingRange;
using mrpt::obs::CObservationOdometry;

/// Pair logs show an action within their first entries; comments and a leading frame may precede
/// it.
constexpr std::size_t kFlavourEntries = 16;

OdometryReading reading_of(CObservationOdometry& odometry) {
  mend_flag(odometry.hasVelocities);
  mend_flag(odometry.hasEncodersInfo);
  OdometryReading reading;
  reading.pose = {odometry.odometry.x(), odometry.odometry.y(), odometry.odometry.phi()};
  const auto& v = odometry.velocityLocal;
  if (odometry.hasVelocities && std::isfinite(v.vx) && std::isfinite(v.vy) &&
      std::isfinite(v.omega))
    reading.velocity = {v.vx, v.vy, v.omega};
  if (odometry.hasEncodersInfo)
    reading.ticks = {odometry.encoderLeftTicks, odometry.encoderRightTicks};
  return reading;
}

/// Where MRPT's programs look for the images of X.rawlog: X_Images beside it, else Images. MRPT's
/// own detectImagesDirectory (2.5.8) loses the separator after the folder of the log.
std::string images_folder(const std::filesystem::path& file) {
  const std::filesystem::path own = file.parent_path() / (file.stem().string() + "_Images");
  return (std::filesystem::is_directory(own) ? own : file.parent_path() / "Images").string();
}

}  // namespace

RawlogPlayer::RawlogPlayer(const std::string& file, const PlayerOptions& options)
    : options_(options),
      intake_(file, options.input.policy),
      guard_(file, options.limits),
      pairs_(intake_),
      pace_(options.pacing) {
  mrpt::img::CImage::setImagesPathBase(images_folder(file));
  decide_flavour();
}

RawlogPlayer::~RawlogPlayer() = default;

void RawlogPlayer::decide_flavour() {
  while (!is_pair_log_ && ahead_.size() < kFlavourEntries) {
    auto entry = guard_.next();
    if (!entry) return;
    is_pair_log_ = entry->kind == EntryKind::kAction;
    ahead_.push_back(std::move(*entry));
  }
}

std::optional<RawlogEntry> RawlogPlayer::fetch() {
  if (ahead_.empty()) return guard_.next();
  std::optional<RawlogEntry> entry = std::move(ahead_.front());
  ahead_.pop_front();
  return entry;
}

std::optional<LogStep> RawlogPlayer::next() {
  while (ready().empty())
    if (finished_ || !read_entry()) return std::nullopt;
  LogStep step = std::move(ready().front());
  ready().pop_front();
  account(step);
  if (pace_.wait(step)) return step;
  finished_ = true;
  ready().clear();
  return std::nullopt;
}

bool RawlogPlayer::read_entry() {
  const auto entry = fetch();
  if (!entry) {
    finished_ = true;
    pairs_.finish();
    splitter_.finish();
    if (!guard_.damage().empty()) intake_.end_early(guard_.damage());
    return !ready().empty();
  }
  ++intake_.summary().entries;
  if (options_.on_entry) options_.on_entry(*entry);
  dispatch(*entry);
  return true;
}

void RawlogPlayer::dispatch(const RawlogEntry& entry) {
  switch (entry.kind) {
    case EntryKind::kAction:
      if (is_pair_log_)
        pairs_.add_action(std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(entry.object),
                          entry.number);
      else
        intake_.skip(entry.number, "action in an observation-only log");
      return;
    case EntryKind::kFrame:
      add_frame(entry);
      return;
    case EntryKind::kObservation:
      add_observation(std::dynamic_pointer_cast<CObservation>(entry.object), entry, entry.bytes);
      return;
    case EntryKind::kForeign:
      intake_.skip(entry.number, "class " + entry.class_name + " has no place in a rawlog");
  }
}

/// The path that a sensor reports of itself is an observation, not the odometry of the robot.
bool RawlogPlayer::is_sensor_path(const CObservation& observation) const {
  const std::string& label = options_.input.sensor_label;
  return !label.empty() && label == observation.sensorLabel;
}

bool RawlogPlayer::is_velocity(const CObservation& observation) const {
  const std::string& label = options_.input.odometry_label;
  return options_.input.odometry == "twist" &&
         dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation) != nullptr &&
         (label.empty() || label == observation.sensorLabel);
}

bool RawlogPlayer::wanted(const CObservation& observation) const {
  const auto matches = [&](const std::string& label) {
    return label.empty() || label == observation.sensorLabel;
  };
  if (dynamic_cast<const CObservationOdometry*>(&observation))
    return is_sensor_path(observation) || (!is_pair_log_ && options_.input.odometry != "twist" &&
                                           matches(options_.input.odometry_label));
  if (dynamic_cast<const CObservationBearingRange*>(&observation))
    return matches(options_.input.sensor_label);
  return dynamic_cast<const mrpt::obs::CObservationComment*>(&observation) == nullptr;
}

void RawlogPlayer::add_frame(const RawlogEntry& entry) {
  const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(entry.object);
  auto kept = mrpt::obs::CSensoryFrame::Create();
  for (const CObservation::Ptr& observation : *frame) {
    if (!observation)
      intake_.skip(entry.number, "null observation in a frame");
    else if (!is_pair_log_)
      add_observation(observation, entry, entry.bytes / frame->size());
    else if (wanted(*observation))
      kept->insert(observation);
  }
  if (is_pair_log_) pairs_.add_frame(kept, entry.number);
}

void RawlogPlayer::add_observation(const CObservation::Ptr& observation, const RawlogEntry& entry,
                                   std::uint64_t bytes) {
  if (is_pair_log_) {
    if (!dynamic_cast<const mrpt::obs::CObservationComment*>(observation.get()))
      intake_.skip(entry.number, "single observation in a log of (action, frame) pairs");
    return;
  }
  if (!wanted(*observation)) return;
  if (auto* odometry = dynamic_cast<CObservationOdometry*>(observation.get());
      odometry != nullptr && !is_sensor_path(*observation)) {
    add_odometry(*odometry, entry);
    return;
  }
  if (is_velocity(*observation)) {
    add_velocity(dynamic_cast<const mrpt::obs::CObservationIMU&>(*observation), entry);
    return;
  }
  const double present = std::max(splitter_.open_time(), splitter_.last_reading_time());
  const auto stamp = stamp_seconds(observation->timestamp);
  double time = stamp.value_or(std::isfinite(present) ? present : 0.0);
  if (!stamp)
    intake_.fill_in(entry.number, "no valid time stamp");
  else if (time < splitter_.open_time()) {
    const double late = splitter_.open_time() - time;
    if (!intake_.may_repair(entry.number, "observation is " + std::to_string(late) + " s late"))
      return;
    time = splitter_.open_time();
  }
  splitter_.add_observation(observation, time, bytes);
}

void RawlogPlayer::add_odometry(CObservationOdometry& odometry, const RawlogEntry& entry) {
  const OdometryReading reading = reading_of(odometry);
  // Poses are absolute: what a missing reading would have said is part of the next one.
  if (!reading.pose.allFinite()) {
    intake_.skip(entry.number, "odometry is not finite");
    return;
  }
  place_reading(reading, stamp_seconds(odometry.timestamp), entry);
}

void RawlogPlayer::add_velocity(const mrpt::obs::CObservationIMU& imu, const RawlogEntry& entry) {
  OdometryReading reading;
  reading.twist = body_velocity(imu);
  if (!reading.twist || !reading.twist->allFinite()) {
    intake_.skip(entry.number, reading.twist ? "velocity is not finite"
                                             : "IMU without linear velocities and turn rates");
    return;
  }
  place_reading(reading, stamp_seconds(imu.timestamp), entry);
}

void RawlogPlayer::place_reading(OdometryReading reading, std::optional<double> stamp,
                                 const RawlogEntry& entry) {
  const double last = splitter_.last_reading_time();
  reading.time = stamp.value_or(std::isfinite(last) ? last : 0.0);
  if (!stamp)
    intake_.fill_in(entry.number, "no valid time stamp");
  else if (reading.time < last) {
    if (!intake_.may_repair(entry.number, "odometry goes back in time by " +
                                              std::to_string(last - reading.time) + " s"))
      return;
    reading.time = last;
  }
  splitter_.add_reading(reading);
}

void RawlogPlayer::account(LogStep& step) {
  InputSummary& summary = intake_.summary();
  if (index_ == 0) first_time_ = step.time;
  step.index = index_++;
  summary.duration_s = step.time - first_time_;
  const bool moves = step.action || step.twist;
  if (moves) {
    ++summary.actions;
    any_motion_ = true;
  }
  if (!step.frame) return;
  summary.observations += static_cast<std::int64_t>(step.frame->size());
  if (!moves && !any_motion_) summary.leading_frame = true;
}

}  // namespace libslam
