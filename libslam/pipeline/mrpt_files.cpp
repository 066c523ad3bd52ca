#include <cstdio>

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <libslam/io/exporters/grid_map.hpp>
#include <libslam/io/exporters/map_picture.hpp>
#include <libslam/io/exporters/scene_3d.hpp>
#include <libslam/pipeline/mrpt_files.hpp>
#include <libslam/result/trajectory.hpp>

namespace libslam {

void MrptFiles::keep(const StepRecord& record, const mrpt::obs::CSensoryFrame::Ptr& frame) {
  if (record.spatial)
    simple_map_.add(*record.spatial, frame, record.time);
  else
    simple_map_.add(record.pose, record.cov, frame, record.time);
}

std::optional<ReportPicture> MrptFiles::render_grid(const LandmarkMap& landmarks) {
  const mrpt::maps::CSimpleMap map = simple_map_.map();
  const auto grid = render_grid_map(map);
  grid_ = grid;
  if (!grid) return std::nullopt;
  const std::vector<std::uint8_t> png = draw_map(*grid, map, landmarks);
  if (png.empty()) return std::nullopt;
  char title[96];
  std::snprintf(title, sizeof title,
                "Landmarks over the laser scans of the key poses, cells of %.2g m",
                static_cast<double>(grid->getResolution()));
  return ReportPicture{title, std::string(png.begin(), png.end())};
}

void MrptFiles::write(const std::filesystem::path& directory, const LandmarkMap& map) const {
  write_scene_3d(directory / "scene.3Dscene",
                 trajectory_of(read_path(directory / "trajectory.csv")), map);
  simple_map_.write(directory / "map.simplemap");
  if (grid_) write_grid_map(directory / "map.gridmap.gz", *grid_);
}

}  // namespace libslam
