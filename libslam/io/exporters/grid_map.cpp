#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <libslam/io/exporters/grid_map.hpp>
#include <libslam/result/atomic_file.hpp>

namespace libslam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::maps::CSimpleMap;
using mrpt::obs::CObservation2DRangeScan;

/// Calls `visit` with the mean pose of every pair and each scan in its frame.
template <typename Visit>
void for_each_scan(const CSimpleMap& map, Visit&& visit) {
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto [pose, frame] = map.get(i);
    if (!pose || !frame) continue;
    for (const auto& observation : *frame)
      if (const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(observation.get()))
        visit(pose->getMeanVal(), *scan);
  }
}

/// All places that a scan may reach.
Eigen::AlignedBox2d extent_of(const CSimpleMap& map, double max_range) {
  Eigen::AlignedBox2d box;
  for_each_scan(map, [&](const mrpt::poses::CPose3D& pose, const CObservation2DRangeScan& scan) {
    const mrpt::poses::CPose3D sensor = pose + scan.sensorPose;
    double reach = 0.0;
    for (std::size_t i = 0; i < scan.getScanSize(); ++i)
      if (scan.getScanRangeValidity(i))
        reach = std::max(reach, static_cast<double>(scan.getScanRange(i)));
    reach = std::min(reach, max_range) + 1.0;
    const Eigen::Vector2d centre(sensor.x(), sensor.y());
    box.extend(centre - Eigen::Vector2d::Constant(reach));
    box.extend(centre + Eigen::Vector2d::Constant(reach));
  });
  return box;
}

double affordable_resolution(const Eigen::AlignedBox2d& box, const GridMapOptions& options) {
  double resolution = options.resolution_m;
  while (box.sizes().prod() / (resolution * resolution) > static_cast<double>(options.max_cells))
    resolution *= 2.0;
  return resolution;
}

}  // namespace

std::shared_ptr<COccupancyGridMap2D> render_grid_map(const CSimpleMap& map,
                                                     const GridMapOptions& options) {
  const Eigen::AlignedBox2d box = extent_of(map, options.max_range_m);
  if (box.isEmpty() || !box.sizes().allFinite()) return nullptr;
  const auto side = [](double value) { return static_cast<float>(value); };
  auto grid = std::make_shared<COccupancyGridMap2D>(side(box.min().x()), side(box.max().x()),
                                                    side(box.min().y()), side(box.max().y()),
                                                    side(affordable_resolution(box, options)));
  grid->insertionOptions.maxDistanceInsertion = side(options.max_range_m);
  grid->insertionOptions.considerInvalidRangesAsFreeSpace = false;
  for_each_scan(map, [&](const mrpt::poses::CPose3D& pose, const CObservation2DRangeScan& scan) {
    grid->insertObservation(scan, pose);
  });
  return grid;
}

void write_grid_map(const std::filesystem::path& file, const COccupancyGridMap2D& grid) {
  replace_file(file, [&](const std::filesystem::path& temporary) {
    mrpt::io::CFileGZOutputStream out;
    if (!out.open(temporary.string())) return false;
    mrpt::serialization::archiveFrom(out) << grid;
    return true;
  });
}

}  // namespace libslam
