#include <array>
#include <stdexcept>
#include <utility>

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/serialization/CArchive.h>

#include <libslam/io/simulated_log.hpp>
#include <libslam/io/truth_writer.hpp>
#include <libslam/map/csv_text.hpp>
#include <libslam/result/atomic_file.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam {
namespace {

namespace fs = std::filesystem;

fs::path beside(const fs::path& rawlog, const char* ending) {
  fs::path file = rawlog;
  return file.replace_extension(ending);
}

fs::path temporary_of(const fs::path& file) {
  return file.parent_path() / (".new-" + file.filename().string());
}

constexpr std::array<const char*, 3> kStreamed = {".rawlog", ".truth.tum", ".truth.csv"};

std::ofstream open_text(const fs::path& file) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  if (!out) throw std::runtime_error("cannot write " + file.string());
  return out;
}

}  // namespace

SimulatedLogWriter::SimulatedLogWriter(const fs::path& rawlog, LogFlavour flavour, bool has_ticks)
    : rawlog_(rawlog),
      flavour_(flavour),
      has_ticks_(has_ticks),
      out_(std::make_unique<mrpt::io::CFileGZOutputStream>()) {
  if (!out_->open(temporary_of(rawlog_).string()))
    throw std::runtime_error("cannot write " + rawlog_.string());
  archive_ = mrpt::serialization::archiveUniquePtrFrom(*out_);
  tum_ = open_text(temporary_of(beside(rawlog_, ".truth.tum")));
  csv_ = open_text(temporary_of(beside(rawlog_, ".truth.csv")));
  csv_ << "t,x,y,phi\n";
}

SimulatedLogWriter::~SimulatedLogWriter() {
  std::error_code ignored;
  for (const char* ending : kStreamed) fs::remove(temporary_of(beside(rawlog_, ending)), ignored);
}

void SimulatedLogWriter::add(const LogStep& step, const Eigen::Vector3d& T_world_robot) {
  ++steps_;
  if (step.frame) observations_ += static_cast<std::int64_t>(step.frame->size());
  if (flavour_ == LogFlavour::kPairs)
    write_pair(step);
  else
    write_observations(step);
  write_truth(step.time, T_world_robot);
}

void SimulatedLogWriter::write_pair(const LogStep& step) {
  if (step.action) *archive_ << *step.action;
  *archive_ << (step.frame ? *step.frame : mrpt::obs::CSensoryFrame());
}

void SimulatedLogWriter::write_observations(const LogStep& step) {
  mrpt::obs::CObservationOdometry reading;
  reading.timestamp = mrpt::Clock::fromDouble(step.time);
  reading.sensorLabel = "odometry";
  if (step.action) {
    const auto motion = step.action->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
    odometry_ = odometry_ + motion->poseChange->getMeanVal();
    reading.hasVelocities = motion->hasVelocities;
    reading.velocityLocal = motion->velocityLocal;
    ticks_ +=
        Eigen::Array2i(motion->encoderLeftTicks, motion->encoderRightTicks).cast<std::int64_t>();
  }
  reading.odometry = odometry_;
  reading.hasEncodersInfo = has_ticks_;  // the first reading starts the counters
  reading.encoderLeftTicks = static_cast<std::int32_t>(ticks_[0]);  // real counters wrap, too
  reading.encoderRightTicks = static_cast<std::int32_t>(ticks_[1]);
  *archive_ << reading;
  if (!step.frame) return;
  for (const auto& observation : *step.frame) *archive_ << *observation;
}

void SimulatedLogWriter::write_truth(double time, const Eigen::Vector3d& pose) {
  std::string row;
  append_tum_row(row, time, pose);
  tum_ << row;
  row.clear();
  append_time(row, time);
  for (const double value : pose) {
    row += ',';
    append_number(row, value);
  }
  csv_ << row << '\n';
}

void SimulatedLogWriter::finish(const std::vector<TrueLandmark>& landmarks,
                                const std::map<std::string, double>& calibration,
                                nlohmann::ordered_json notes) {
  archive_.reset();
  out_->close();
  tum_.close();
  csv_.close();
  if (!tum_ || !csv_) throw std::runtime_error("cannot write the truth of " + rawlog_.string());
  for (const char* ending : kStreamed) {
    const fs::path file = beside(rawlog_, ending);
    fs::rename(temporary_of(file), file);
  }
  std::error_code ignored;
  fs::remove(beside(rawlog_, ".landmarks.csv"), ignored);  // of an earlier drive
  if (!landmarks.empty())
    replace_file(beside(rawlog_, ".landmarks.csv"), landmarks_text(landmarks));
  notes["has_heading"] = true;
  notes["calibration"] = calibration;
  replace_file(beside(rawlog_, ".truth.json"), notes.dump(2) + "\n");
}

}  // namespace libslam
