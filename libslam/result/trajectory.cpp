#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include <libslam/map/csv_text.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam {
namespace {

constexpr std::string_view kLeadingColumns = "time,step,";
constexpr std::string_view kPlanarColumns =
    "x,y,phi,cov_xx,cov_xy,cov_xphi,cov_yy,cov_yphi,cov_phiphi";
constexpr std::string_view kSpatialColumns =
    "x,y,z,qx,qy,qz,qw,"
    "cov_xx,cov_xy,cov_xz,cov_xrx,cov_xry,cov_xrz,cov_yy,cov_yz,cov_yrx,cov_yry,cov_yrz,"
    "cov_zz,cov_zrx,cov_zry,cov_zrz,cov_rxrx,cov_rxry,cov_rxrz,cov_ryry,cov_ryrz,cov_rzrz";
constexpr std::string_view kStatisticsColumns =
    ",nis,nis_dof,accepted,gated,ambiguous,new_landmarks";
constexpr std::size_t kPlanarCount = 17, kSpatialCount = 36;

std::string fixed_columns(bool spatial) {
  std::string text(kLeadingColumns);
  return text.append(spatial ? kSpatialColumns : kPlanarColumns).append(kStatisticsColumns);
}

std::size_t cell_count(const TrajectoryColumns& columns) {
  return (columns.spatial ? kSpatialCount : kPlanarCount) + 2 * columns.calibration.size() +
         columns.noise.size() + (columns.events ? 1 : 0);
}

void append_cell(std::string& text, auto value) {
  text += ',';
  append_number(text, value);
}

void append_decimal(std::string& text, double value) {
  std::array<char, 352> buffer;  // the longest double in fixed notation
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                          std::chars_format::fixed, 9);
  text += ' ';
  text.append(buffer.data(), end);
}

void append_pose(std::string& text, const Eigen::Vector3d& pose, const Eigen::Matrix3d& cov) {
  for (int i = 0; i < 3; ++i) append_cell(text, pose(i));
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) append_cell(text, cov(i, j));
}

void append_pose(std::string& text, const SpatialEstimate& estimate) {
  for (const double value : estimate.pose.position) append_cell(text, value);
  for (const double value : estimate.pose.rotation.coeffs()) append_cell(text, value);
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) append_cell(text, estimate.cov(i, j));
}

template <int N>
void read_covariance(Eigen::Matrix<double, N, N>& cov, auto&& number) {
  for (int i = 0; i < N; ++i)
    for (int j = i; j < N; ++j) cov(i, j) = cov(j, i) = number();
}

void read_spatial(StepRecord& step, auto&& number) {
  SpatialEstimate& estimate = step.spatial.emplace();
  for (double& value : estimate.pose.position) value = number();
  for (double& value : estimate.pose.rotation.coeffs()) value = number();
  read_covariance(estimate.cov, number);
  step.pose = shadow_of(estimate.pose);
  step.cov = shadow_covariance(estimate);
}

}  // namespace

TrajectoryColumns columns_of(const StepRecord& step, bool events) {
  TrajectoryColumns columns{step.spatial.has_value(), {}, {}, events};
  for (const CalibrationValue& value : step.calibration) columns.calibration.push_back(value.name);
  for (const AdaptedNoise& noise : step.noise) columns.noise.push_back(noise.name);
  return columns;
}

void append_trajectory_header(std::string& text, const TrajectoryColumns& columns) {
  text += fixed_columns(columns.spatial);
  for (const std::string& name : columns.calibration) text += ',' + name + ",sigma_" + name;
  for (const std::string& name : columns.noise) text += ",noise_" + name;
  if (columns.events) text += ",event";
  text += '\n';
}

void append_trajectory_row(std::string& text, const StepRecord& step, bool events) {
  append_time(text, step.time);
  append_cell(text, step.index);
  if (step.spatial)
    append_pose(text, *step.spatial);
  else
    append_pose(text, step.pose, step.cov);
  append_cell(text, step.nis);
  for (const int count :
       {step.nis_dof, step.accepted, step.gated, step.ambiguous, step.new_landmarks})
    append_cell(text, count);
  for (const CalibrationValue& value : step.calibration) {
    append_cell(text, value.mean);
    append_cell(text, value.sigma);
  }
  for (const AdaptedNoise& noise : step.noise) append_cell(text, noise.sigma);
  if (events) text += ',' + step.event;
  text += '\n';
}

void append_tum_row(std::string& text, double time, const Eigen::Vector3d& pose) {
  append_time(text, time);
  for (const double value :
       {pose.x(), pose.y(), 0.0, 0.0, 0.0, std::sin(pose.z() / 2), std::cos(pose.z() / 2)})
    append_decimal(text, value);
  text += '\n';
}

void append_tum_row(std::string& text, double time, const SpatialPose& pose) {
  append_time(text, time);
  for (const double value : pose.position) append_decimal(text, value);
  for (const double value : pose.rotation.coeffs()) append_decimal(text, value);
  text += '\n';
}

std::string tum_text(const Trajectory& path) {
  std::string text;
  for (std::size_t i = 0; i < path.times.size(); ++i)
    if (path.spatial.empty())
      append_tum_row(text, path.times[i], path.poses[i]);
    else
      append_tum_row(text, path.times[i], path.spatial[i]);
  return text;
}

TrajectoryReader::TrajectoryReader(const std::filesystem::path& file)
    : name_(file.string()), in_(file) {
  if (!in_) throw std::runtime_error("cannot open " + name_);
  if (!read_line()) throw_at({name_, 1}, "no header");
  read_header();
}

void TrajectoryReader::read_header() {
  columns_.spatial = std::string_view(line_).starts_with(fixed_columns(true));
  std::size_t i = columns_.spatial ? kSpatialCount : kPlanarCount;
  bool known = std::string_view(line_).starts_with(fixed_columns(columns_.spatial));
  const auto is_pair = [&] {
    return i + 1 < cells_.size() && cells_[i + 1] == "sigma_" + std::string(cells_[i]);
  };
  for (; known && is_pair(); i += 2) columns_.calibration.emplace_back(cells_[i]);
  constexpr std::string_view kNoise = "noise_";
  for (; known && i < cells_.size() && cells_[i].starts_with(kNoise); ++i)
    columns_.noise.emplace_back(cells_[i].substr(kNoise.size()));
  columns_.events = known && i < cells_.size() && cells_[i] == "event";
  known = known && cells_.size() == cell_count(columns_);
  if (!known) throw_at({name_, 1}, "not the header of a trajectory.csv");
}

bool TrajectoryReader::read_line() {
  if (!std::getline(in_, line_) || in_.eof()) return false;
  ++line_number_;
  split_cells(line_, cells_);
  return true;
}

bool TrajectoryReader::next(StepRecord& step) {
  if (!read_line()) return false;
  const TextPlace place{name_, line_number_};
  const std::size_t expected = cell_count(columns_);
  if (cells_.size() != expected)
    throw_at(place, "expected " + std::to_string(expected) + " cells, found " +
                        std::to_string(cells_.size()));
  auto cell = cells_.begin();
  const auto number = [&] { return parse_number(*cell++, place); };
  const auto integer = [&] { return parse_integer(*cell++, place); };
  step.time = number();
  step.index = integer();
  if (columns_.spatial) {
    read_spatial(step, number);
  } else {
    for (double& value : step.pose) value = number();
    read_covariance(step.cov, number);
    step.spatial.reset();
  }
  step.nis = number();
  for (int* count :
       {&step.nis_dof, &step.accepted, &step.gated, &step.ambiguous, &step.new_landmarks})
    *count = static_cast<int>(integer());
  step.calibration.resize(columns_.calibration.size());
  for (std::size_t i = 0; i < step.calibration.size(); ++i) {
    step.calibration[i].name = columns_.calibration[i];
    step.calibration[i].mean = number();
    step.calibration[i].sigma = number();
  }
  step.noise.resize(columns_.noise.size());
  for (std::size_t i = 0; i < step.noise.size(); ++i)
    step.noise[i] = {columns_.noise[i], number(), 0.0};
  step.event.clear();
  if (columns_.events) step.event = *cell;
  return true;
}

Trajectory trajectory_of(const PathView& path) {
  Trajectory trajectory;
  for (const EstimatedPose& step : path.poses) {
    trajectory.times.push_back(step.time);
    trajectory.poses.push_back(step.pose);
  }
  for (const SpatialEstimate& step : path.spatial) trajectory.spatial.push_back(step.pose);
  return trajectory;
}

EstimatedPath read_path(const std::filesystem::path& file) {
  EstimatedPath path;
  TrajectoryReader reader(file);
  for (StepRecord step; reader.next(step);) {
    path.poses.push_back({step.index, step.time, step.pose, step.cov});
    if (step.spatial) path.spatial.push_back(*step.spatial);
  }
  return path;
}

std::vector<EstimatedPose> read_estimated_path(const std::filesystem::path& file) {
  return read_path(file).poses;
}

}  // namespace libslam
