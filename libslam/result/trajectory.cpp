#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include <libslam/map/csv_text.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam {
namespace {

constexpr std::string_view kFixedColumns =
    "time,step,x,y,phi,cov_xx,cov_xy,cov_xphi,cov_yy,cov_yphi,cov_phiphi,"
    "nis,nis_dof,accepted,gated,ambiguous,new_landmarks";
constexpr std::size_t kFixedCount = 17;

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

}  // namespace

void append_trajectory_header(std::string& text, const std::vector<CalibrationValue>& calibration) {
  text += kFixedColumns;
  for (const CalibrationValue& value : calibration)
    text += ',' + value.name + ",sigma_" + value.name;
  text += '\n';
}

void append_trajectory_row(std::string& text, const StepRecord& step) {
  append_time(text, step.time);
  append_cell(text, step.index);
  for (int i = 0; i < 3; ++i) append_cell(text, step.pose(i));
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) append_cell(text, step.cov(i, j));
  append_cell(text, step.nis);
  for (const int count :
       {step.nis_dof, step.accepted, step.gated, step.ambiguous, step.new_landmarks})
    append_cell(text, count);
  for (const CalibrationValue& value : step.calibration) {
    append_cell(text, value.mean);
    append_cell(text, value.sigma);
  }
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

TrajectoryReader::TrajectoryReader(const std::filesystem::path& file)
    : name_(file.string()), in_(file) {
  if (!in_) throw std::runtime_error("cannot open " + name_);
  if (!read_line()) throw_at({name_, 1}, "no header");
  if (!std::string_view(line_).starts_with(kFixedColumns) || (cells_.size() - kFixedCount) % 2 != 0)
    throw_at({name_, 1}, "not the header of a trajectory.csv");
  for (std::size_t i = kFixedCount; i < cells_.size(); i += 2)
    calibration_names_.emplace_back(cells_[i]);
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
  const std::size_t expected = kFixedCount + 2 * calibration_names_.size();
  if (cells_.size() != expected)
    throw_at(place, "expected " + std::to_string(expected) + " cells, found " +
                        std::to_string(cells_.size()));
  auto cell = cells_.begin();
  const auto number = [&] { return parse_number(*cell++, place); };
  const auto integer = [&] { return parse_integer(*cell++, place); };
  step.time = number();
  step.index = integer();
  for (int i = 0; i < 3; ++i) step.pose(i) = number();
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) step.cov(i, j) = step.cov(j, i) = number();
  step.nis = number();
  for (int* count :
       {&step.nis_dof, &step.accepted, &step.gated, &step.ambiguous, &step.new_landmarks})
    *count = static_cast<int>(integer());
  step.calibration.resize(calibration_names_.size());
  for (std::size_t i = 0; i < calibration_names_.size(); ++i) {
    step.calibration[i].name = calibration_names_[i];
    step.calibration[i].mean = number();
    step.calibration[i].sigma = number();
  }
  return true;
}

std::vector<EstimatedPose> read_estimated_path(const std::filesystem::path& file) {
  std::vector<EstimatedPose> path;
  TrajectoryReader reader(file);
  for (StepRecord step; reader.next(step);)
    path.push_back({step.index, step.time, step.pose, step.cov});
  return path;
}

}  // namespace libslam
