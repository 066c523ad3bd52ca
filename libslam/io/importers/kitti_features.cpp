#include <algorithm>
#include <filesystem>

#include <libslam/io/importers/kitti_features.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/input_file.hpp>
#include <libslam/io/text_reader.hpp>

namespace libslam {
namespace {

using Row34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
/// What seven printed digits leave of an orthonormal matrix.
constexpr double kPrinted = 1e-4;

Eigen::Isometry3d rigid(const TextReader& row, const Row34& m) {
  const Eigen::Matrix3d R = m.leftCols<3>();
  if (!(R * R.transpose()).isIdentity(kPrinted) || R.determinant() < 0.0)
    row.reject("the matrix holds no rotation");
  return Eigen::Translation3d(m.col(3)) * Eigen::Quaterniond(R).normalized();
}

/// Twelve numbers of a 3 x 4 matrix, row by row, from column `first`.
Eigen::Isometry3d read_pose(const TextReader& row, std::size_t first) {
  Row34 m;
  for (std::size_t i = 0; i < 12; ++i) m.data()[i] = row.number(first + i);
  return rigid(row, m);
}

StereoCamera read_camera(const std::string& file) {
  StereoCamera camera;
  bool posed = false;
  TextReader row(file);
  while (row.next()) {  // "name = numbers"
    const std::string_view name = row.word(0);
    if (name == "K") {
      row.require_columns(11);
      camera.fx = row.number(2);
      camera.cx = row.number(4);
      camera.fy = row.number(6);
      camera.cy = row.number(7);
    } else if (name == "baseline") {
      camera.baseline = row.number(2);
    } else if (name == "cam_T_imu") {
      camera.T_robot_camera = read_pose(row, 2).inverse();
      posed = true;
    }
  }
  if (!posed || !(camera.fx > 0.0 && camera.fy > 0.0 && camera.baseline > 0.0))
    throw InputError(file + ": K, baseline and cam_T_imu are needed, lengths positive");
  return camera;
}

void read_velocities(const std::string& file, SpatialLog& log) {
  TextReader row(file);  // frame, t, v (3), omega (3)
  while (row.next()) {
    row.require_columns(8);
    if (row.integer(0) != static_cast<std::int64_t>(log.steps.size()))
      row.reject("frames do not count up from 0");
    SpatialStep step;
    step.time = row.number(1);
    if (!log.steps.empty() && step.time <= log.steps.back().time)
      row.reject("time does not increase");
    for (Eigen::Index i = 0; i < 6; ++i)
      step.twist[i] = row.number(2 + static_cast<std::size_t>(i));
    log.steps.push_back(std::move(step));
  }
  if (log.steps.empty()) throw InputError(file + ": holds no rows");
}

void read_sightings(const std::string& file, SpatialLog& log) {
  TextReader row(file);  // frame, id, u_left, v_left, u_right, v_right
  std::int64_t surplus = 0;
  while (row.next()) {
    row.require_columns(6);
    const std::int64_t frame = row.integer(0), id = row.integer(1);
    if (frame < 0) row.reject("a frame is not negative");
    if (id < 0 || id > INT32_MAX) row.reject("feature id out of range");
    if (frame >= static_cast<std::int64_t>(log.steps.size())) {
      ++surplus;
      continue;
    }
    log.steps[static_cast<std::size_t>(frame)].sightings.push_back(
        {id, {row.number(2), row.number(3), row.number(4), row.number(5)}});
  }
  log.remarks["left_out"] = std::to_string(surplus) + " points of frames without velocities";
}

/// The file of true poses, or nothing.
std::string find_poses(const std::string& directory) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(directory))
    if (entry.path().filename().string().starts_with("gt_poses_seq"))
      found.push_back(entry.path().string());
  std::ranges::sort(found);
  return found.empty() ? std::string() : found.front();
}

/// Poses of the left camera in the frame of its first, row i of frame i.
void read_poses(const std::string& file, SpatialLog& log) {
  TextReader row(file);
  Trajectory& path = log.truth.path;
  const Eigen::Isometry3d T_robot_camera = log.camera.T_robot_camera;
  while (row.next() && path.times.size() < log.steps.size()) {
    row.require_columns(12);
    const Eigen::Isometry3d T = T_robot_camera * read_pose(row, 0) * T_robot_camera.inverse();
    path.times.push_back(log.steps[path.times.size()].time);
    path.spatial.push_back({T.translation(), Eigen::Quaterniond(T.linear())});
    path.poses.push_back(shadow_of(path.spatial.back()));
  }
}

}  // namespace

SpatialLog import_kitti_features(const std::string& directory) {
  SpatialLog log;
  std::filesystem::path folder = std::filesystem::path(directory).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  log.scenario = "KITTI features, " + folder.filename().string();
  log.camera = read_camera(find_input_file(directory, "calib.txt"));
  read_velocities(find_input_file(directory, "imu_velocity.csv"), log);
  read_sightings(find_input_file(directory, "stereo_features.csv"), log);
  const std::string poses = find_poses(directory);
  if (!poses.empty()) read_poses(poses, log);
  log.remarks["path"] = poses.empty() ? "not part of the data set"
                                      : "IMU in the frame of frame 0, from the odometry benchmark";
  return log;
}

}  // namespace libslam
