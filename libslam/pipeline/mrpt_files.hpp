#pragma once
// What a run leaves behind for MRPT's own tools.

#include <filesystem>
#include <memory>
#include <optional>

#include <mrpt/obs/CSensoryFrame.h>

#include <libslam/data/step_record.hpp>
#include <libslam/io/exporters/simple_map.hpp>
#include <libslam/map/landmark_map.hpp>
#include <libslam/result/report_picture.hpp>

namespace mrpt::maps {
class COccupancyGridMap2D;
}

namespace libslam {

/// scene.3Dscene and map.simplemap, and map.gridmap.gz where a planar laser was there.
class MrptFiles {
 public:
  /// Keeps the frame, if it is a key frame. It must not be changed afterwards.
  void keep(const StepRecord& record, const mrpt::obs::CSensoryFrame::Ptr& frame);
  /// Moves the key frames to where the robot is now known to have been (a path in the plane).
  void correct(const Trajectory& path) { simple_map_.correct(path); }
  /// Renders the grid of what was kept; a picture of it under `landmarks` for the report, or
  /// nothing.
  std::optional<ReportPicture> render_grid(const LandmarkMap& landmarks);
  /// Writes the files into a run directory that holds trajectory.csv. Throws std::runtime_error
  /// naming the file that cannot be written.
  void write(const std::filesystem::path& directory, const LandmarkMap& map) const;

 private:
  SimpleMapWriter simple_map_;
  std::shared_ptr<const mrpt::maps::COccupancyGridMap2D> grid_;
};

}  // namespace libslam
