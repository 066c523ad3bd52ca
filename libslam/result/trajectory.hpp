#pragma once
// The path of a run as text: trajectory.csv row by row, and the TUM form.

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <libslam/data/step_record.hpp>

namespace libslam {

/// Header of trajectory.csv for steps with these calibration parameters:
/// time [s], step, x, y [m], phi [rad], the upper triangle of the covariance of (x, y, phi), nis,
/// nis_dof, accepted, gated, ambiguous, new_landmarks, then `<name>,sigma_<name>` per parameter.
void append_trajectory_header(std::string& text, const std::vector<CalibrationValue>& calibration);

/// One row of trajectory.csv; numbers read back bit for bit, the time to a nanosecond.
void append_trajectory_row(std::string& text, const StepRecord& step);

/// One TUM line `t x y z qx qy qz qw`: 9 decimals, fixed notation.
void append_tum_row(std::string& text, double time, const Eigen::Vector3d& pose);
void append_tum_row(std::string& text, double time, const SpatialPose& pose);

/// Streams trajectory.csv. A last line without line end, as a killed run may leave, is not read.
class TrajectoryReader {
 public:
  /// Throws std::runtime_error naming the file where it cannot be opened or has another header.
  explicit TrajectoryReader(const std::filesystem::path& file);

  /// Fills `step` (of the calibration: name, mean and sigma) and returns true, or false at the end.
  /// Throws std::runtime_error "file:line: ..." on a malformed row.
  bool next(StepRecord& step);

  /// Names of the calibration parameters, in column order.
  const std::vector<std::string>& calibration_names() const { return calibration_names_; }

 private:
  bool read_line();

  std::string name_;
  std::ifstream in_;
  std::int64_t line_number_ = 0;
  std::string line_;
  std::vector<std::string_view> cells_;
  std::vector<std::string> calibration_names_;
};

/// What the comparison with truth needs of a step.
struct EstimatedPose {
  std::int64_t step = 0;
  double time = 0.0;                               ///< [s]
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< x [m], y [m], phi [rad]
  Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();   ///< covariance of `pose`, additive
};

/// All rows of a trajectory.csv. Throws like TrajectoryReader.
std::vector<EstimatedPose> read_estimated_path(const std::filesystem::path& file);

}  // namespace libslam
