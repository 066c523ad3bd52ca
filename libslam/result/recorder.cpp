#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include <libslam/result/atomic_file.hpp>
#include <libslam/result/recorder.hpp>
#include <libslam/result/report.hpp>

namespace libslam {
namespace {

namespace fs = std::filesystem;

/// What a run leaves behind; the only names that `force` removes.
constexpr std::array<const char*, 12> kRunFiles = {
    "run.json",       "config.yaml",   "trajectory.tum", "trajectory_smoothed.tum",
    "map.csv",        "report.html",   "map.simplemap",  "trajectory.csv",
    "map.gridmap.gz", "scene.3Dscene", "log.txt",        "checkpoint"};

void prepare_directory(const fs::path& directory, bool force) {
  std::error_code error;
  if (fs::exists(directory, error)) {
    if (!fs::is_directory(directory, error))
      throw std::runtime_error(directory.string() + " exists and is not a directory");
    if (!fs::is_empty(directory, error) && !error && !force)
      throw std::runtime_error(directory.string() +
                               " is not empty (--force replaces the run in it)");
    if (!error)
      for (const char* name : kRunFiles) fs::remove_all(directory / name, error);
  } else if (!error) {
    fs::create_directories(directory, error);
  }
  if (error)
    throw std::runtime_error("cannot write " + directory.string() + ": " + error.message());
}

std::ofstream open_for_writing(const fs::path& file) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  if (!out) throw std::runtime_error("cannot write " + file.string());
  return out;
}

void append(std::ofstream& out, const std::string& text, const fs::path& file) {
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.flush();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

/// A row that cannot be read back would cost the whole file at the end.
void check_readable(const StepRecord& step) {
  bool finite = std::isfinite(step.time) && step.pose.allFinite() && step.cov.allFinite() &&
                std::isfinite(step.nis);
  if (step.spatial)
    finite = finite && step.spatial->pose.position.allFinite() &&
             step.spatial->pose.rotation.coeffs().allFinite() && step.spatial->cov.allFinite();
  for (const CalibrationValue& value : step.calibration)
    finite = finite && std::isfinite(value.mean) && std::isfinite(value.sigma);
  for (const AdaptedNoise& noise : step.noise)
    finite = finite && std::isfinite(noise.sigma) && std::isfinite(noise.configured);
  if (!finite) throw std::invalid_argument("step " + std::to_string(step.index) + " is not finite");
  for (const unsigned char c : step.event)
    if (c < ' ' || c == ',' || c == 127)
      throw std::invalid_argument("step " + std::to_string(step.index) +
                                  ": the event is not plain text: " + step.event);
}

}  // namespace

Recorder::Recorder(RecorderOptions options) : options_(std::move(options)) {
  prepare_directory(options_.directory, options_.force);
  csv_ = open_for_writing(options_.directory / "trajectory.csv");
  tum_ = open_for_writing(options_.directory / "trajectory.tum");
}

void Recorder::record(const StepRecord& step) {
  check_readable(step);
  statistics_.add(step);
  last_ = step;
  last_is_written_ = !has_header_ || step.nis_dof > 0 ||
                     step.time - last_row_time_ >= options_.trajectory_period_s;
  if (last_is_written_) write_row(step);
}

void Recorder::check_columns(const StepRecord& step) const {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument("step " + std::to_string(step.index) + " has " + what);
  };
  if (step.spatial.has_value() != is_spatial_)
    refuse(is_spatial_ ? "no pose in space, the first had one"
                       : "a pose in space, the first had none");
  if (step.calibration.size() != calibration_count_)
    refuse(std::to_string(step.calibration.size()) + " calibration parameters, the first had " +
           std::to_string(calibration_count_));
  if (step.noise.size() != noise_count_)
    refuse(std::to_string(step.noise.size()) + " adapted noises, the first had " +
           std::to_string(noise_count_));
}

void Recorder::write_row(const StepRecord& step) {
  text_.clear();
  if (has_header_) {
    check_columns(step);
  } else {
    append_trajectory_header(text_, columns_of(step, options_.events));
    is_spatial_ = step.spatial.has_value();
    calibration_count_ = step.calibration.size();
    noise_count_ = step.noise.size();
  }
  append_trajectory_row(text_, step, options_.events);
  append(csv_, text_, options_.directory / "trajectory.csv");
  text_.clear();
  if (step.spatial)
    append_tum_row(text_, step.time, step.spatial->pose);
  else
    append_tum_row(text_, step.time, step.pose);
  append(tum_, text_, options_.directory / "trajectory.tum");
  has_header_ = true;
  last_row_time_ = step.time;
}

void Recorder::add_smoothed_path(Trajectory path) {
  replace_file(options_.directory / "trajectory_smoothed.tum", tum_text(path));
  smoothed_ = std::move(path);
}

void Recorder::add_picture(ReportPicture picture) {
  check_picture(picture);
  pictures_.push_back(std::move(picture));
}

void Recorder::fill_result(RunSummary& summary, const LandmarkMap& map) const {
  statistics_.fill(summary);
  RunSummary::Result& result = summary.result;
  if (last_ && !result.pose && !result.pose3d) {
    if (last_->spatial)
      result.pose3d = last_->spatial->pose;
    else
      result.pose = last_->pose;
  }
  result.landmarks = static_cast<std::int64_t>(map.size());
  if (result.calibration.empty()) result.calibration = statistics_.calibration();
  if (result.noise.empty()) result.noise = statistics_.noise();
  if (options_.events && !summary.health.disturbances)
    summary.health.disturbances = statistics_.disturbances();
}

RunSummary Recorder::finish(RunSummary summary, const LandmarkMap& map, const GroundTruth& truth,
                            LandmarkIdentity identity) {
  if (!last_is_written_) write_row(*last_);
  last_is_written_ = true;
  if (!has_header_) {
    text_.clear();
    append_trajectory_header(text_, {});
    append(csv_, text_, options_.directory / "trajectory.csv");
    has_header_ = true;
  }
  std::ostringstream map_text;
  write_landmark_map(map_text, map);
  replace_file(options_.directory / "map.csv", map_text.str());

  fill_result(summary, map);
  const EstimatedPath path = read_path(options_.directory / "trajectory.csv");
  if (!truth.empty())
    summary.truth = compare_with_truth(path, map, calibration_means(summary.result.calibration),
                                       truth, identity, {summary.result.placement});
  if (smoothed_ && summary.truth)
    compare_smoothed(*smoothed_, path.poses, truth, {summary.result.placement}, *summary.truth);
  replace_file(options_.directory / "run.json", to_json_text(summary));
  if (options_.report)
    replace_file(
        options_.directory / "report.html",
        make_report({summary, map, path, options_.directory / "trajectory.csv", truth,
                     statistics_.step_times(), pictures_, smoothed_ ? &*smoothed_ : nullptr}));
  return summary;
}

}  // namespace libslam
