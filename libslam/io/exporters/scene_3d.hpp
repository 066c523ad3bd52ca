#pragma once
// scene.3Dscene: path and landmarks for MRPT's SceneViewer3D.

#include <filesystem>

#include <libslam/data/trajectory.hpp>
#include <libslam/map/landmark_map.hpp>

namespace libslam {

/// Writes a scene with a ground grid, the path as a line, the last pose as a corner, and the 95 %
/// ellipsoid of every point landmark with its id. A path in space is drawn there; at most 20000
/// poses are. Landmarks of other types are left out. Replaces `file` at once or not at all. Throws
/// std::runtime_error naming it where it cannot be written.
void write_scene_3d(const std::filesystem::path& file, const Trajectory& path,
                    const LandmarkMap& map);

}  // namespace libslam
