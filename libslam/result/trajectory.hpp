#pragma once
// The path of a run as text: trajectory.csv row by row, and the TUM form.

#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <libslam/data/step_record.hpp>
#include <libslam/data/trajectory.hpp>

namespace libslam {

/// Which columns trajectory.csv has beyond those of every run.
struct TrajectoryColumns {
  bool spatial = false;                  ///< of a run in space
  std::vector<std::string> calibration;  ///< names of the parameters
  std::vector<std::string> noise;        ///< names of the adapted noises
  bool events = false;
};

/// The columns that `step` fills; `events`: whether any step of its run may hold an event.
TrajectoryColumns columns_of(const StepRecord& step, bool events = false);

/// Header of trajectory.csv: time [s], step, the pose with the upper triangle of its covariance,
/// nis, nis_dof, accepted, gated, ambiguous, new_landmarks, then `<name>,sigma_<name>` per
/// calibration parameter, `noise_<name>` per adapted noise and `event`.
///
/// The pose is x, y [m], phi [rad] in the plane, and x, y, z [m], qx, qy, qz, qw in space, there
/// with the covariance of (x, y, z, rx, ry, rz) as SpatialEstimate holds it.
void append_trajectory_header(std::string& text, const TrajectoryColumns& columns);

/// One row of trajectory.csv; numbers read back bit for bit, the time to a nanosecond. An event
/// must be free of commas and control characters.
void append_trajectory_row(std::string& text, const StepRecord& step, bool events = false);

/// One TUM line `t x y z qx qy qz qw`: 9 decimals, fixed notation.
void append_tum_row(std::string& text, double time, const Eigen::Vector3d& pose);
void append_tum_row(std::string& text, double time, const SpatialPose& pose);
/// All rows of a path with times, in space where it is.
std::string tum_text(const Trajectory& path);

/// Streams trajectory.csv. A last line without line end, as a killed run may leave, is not read.
class TrajectoryReader {
 public:
  /// Throws std::runtime_error naming the file where it cannot be opened or has another header.
  explicit TrajectoryReader(const std::filesystem::path& file);

  /// Fills `step` (of the calibration: name, mean and sigma; of adapted noise: name and sigma) and
  /// returns true, or false at the end. In space `pose` and `cov` are the shadow.
  /// Throws std::runtime_error "file:line: ..." on a malformed row.
  bool next(StepRecord& step);

  const TrajectoryColumns& columns() const { return columns_; }

 private:
  bool read_line();
  void read_header();

  std::string name_;
  std::ifstream in_;
  std::int64_t line_number_ = 0;
  std::string line_;
  std::vector<std::string_view> cells_;
  TrajectoryColumns columns_;
};

/// What the comparison with truth needs of a step.
struct EstimatedPose {
  std::int64_t step = 0;
  double time = 0.0;                               ///< [s]
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< x [m], y [m], phi [rad]
  Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();   ///< covariance of `pose`, additive
};

/// The path of a run. `spatial` is empty, or of a run in space and as long as `poses`, which are
/// its shadow then.
struct EstimatedPath {
  std::vector<EstimatedPose> poses;
  std::vector<SpatialEstimate> spatial;
};

/// A path that somebody else holds.
struct PathView {
  PathView() = default;
  PathView(const std::vector<EstimatedPose>& planar) : poses(planar) {}
  PathView(std::span<const EstimatedPose> planar) : poses(planar) {}
  PathView(const EstimatedPath& path) : poses(path.poses), spatial(path.spatial) {}

  std::span<const EstimatedPose> poses;
  std::span<const SpatialEstimate> spatial;
};

/// The path without covariances.
Trajectory trajectory_of(const PathView& path);

/// All rows of a trajectory.csv. Throws like TrajectoryReader.
EstimatedPath read_path(const std::filesystem::path& file);
/// The same, in space only the shadow.
std::vector<EstimatedPose> read_estimated_path(const std::filesystem::path& file);

}  // namespace libslam
