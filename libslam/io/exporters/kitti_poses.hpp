#pragma once
// trajectory.kitti: poses as the tools of the KITTI odometry benchmark read them.

#include <filesystem>
#include <string>

#include <libslam/data/trajectory.hpp>

namespace libslam {

/// One line per pose: the first three rows of T_world_body, row by row, 12 numbers that read back
/// bit for bit. There are no times: truth must have as many lines, in the same order. The benchmark
/// itself has z along the optical axis; axes are left as the run has them. A planar path is at
/// height 0.
std::string kitti_poses_text(const Trajectory& path);

/// Replaces `file` at once or not at all. Throws std::runtime_error naming it where it cannot be
/// written.
void write_kitti_poses(const std::filesystem::path& file, const Trajectory& path);

}  // namespace libslam
