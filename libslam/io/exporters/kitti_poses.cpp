#include <libslam/io/exporters/kitti_poses.hpp>
#include <libslam/map/csv_text.hpp>
#include <libslam/result/atomic_file.hpp>
#include <libslam/result/spatial_alignment.hpp>

namespace libslam {

std::string kitti_poses_text(const Trajectory& path) {
  std::string text;
  for (const SpatialPose& pose : path.spatial.empty() ? lift_to_space(path.poses) : path.spatial) {
    const Eigen::Matrix4d T = pose.isometry().matrix();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j) {
        if (i + j > 0) text += ' ';
        append_number(text, T(i, j));
      }
    text += '\n';
  }
  return text;
}

void write_kitti_poses(const std::filesystem::path& file, const Trajectory& path) {
  replace_file(file, kitti_poses_text(path));
}

}  // namespace libslam
