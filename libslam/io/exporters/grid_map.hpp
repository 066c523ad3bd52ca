#pragma once
// map.gridmap.gz: what a laser saw from key poses, as an occupancy grid for MRPT's own tools.

#include <filesystem>
#include <memory>

#include <mrpt/maps/CSimpleMap.h>

namespace mrpt::maps {
class COccupancyGridMap2D;
}

namespace libslam {

struct GridMapOptions {
  double resolution_m = 0.05;         ///< side of a cell, doubled until the grid is small enough
  double max_range_m = 15.0;          ///< returns from farther away are left out
  std::size_t max_cells = 16U << 20;  ///< a byte each
};

/// The planar laser scans of `map`, each inserted from its mean pose. Null where it holds none.
std::shared_ptr<mrpt::maps::COccupancyGridMap2D> render_grid_map(
    const mrpt::maps::CSimpleMap& map, const GridMapOptions& options = {});

/// Replaces `file` at once or not at all. Throws std::runtime_error naming it where it cannot be
/// written.
void write_grid_map(const std::filesystem::path& file, const mrpt::maps::COccupancyGridMap2D& grid);

}  // namespace libslam
