#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <libslam/io/exporters/grid_map.hpp>
#include <libslam/result/atomic_file.hpp>

namespace libslam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::maps::CSimpleMap;
using mrpt::obs::CObservation2DRangeScan;

/// Calls `visit` with the mean pose and the frame of every pair.
template <typename Visit>
void for_each_pair(const CSimpleMap& map, Visit&& visit) {
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto [pose, frame] = map.get(i);
    if (pose && frame) visit(pose->getMeanVal(), *frame);
  }
}

template <typename Visit>
void for_each_scan(const CSimpleMap& map, Visit&& visit) {
  for_each_pair(map, [&](const mrpt::poses::CPose3D& pose, const mrpt::obs::CSensoryFrame& frame) {
    for (const auto& observation : frame)
      if (const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(observation.get()))
        visit(pose, *scan);
  });
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

std::vector<std::uint8_t> draw_grid_map(const COccupancyGridMap2D& grid, const CSimpleMap& map,
                                        int max_side) {
  const int width = static_cast<int>(grid.getSizeX()), height = static_cast<int>(grid.getSizeY());
  cv::Mat cells(height, width, CV_8UC1);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      cells.at<std::uint8_t>(height - 1 - row, column) =
          static_cast<std::uint8_t>(std::lround(255.0F * grid.getCell(column, row)));
  const double scale = std::min(1.0, static_cast<double>(max_side) / std::max(width, height));
  if (scale < 1.0) cv::resize(cells, cells, {}, scale, scale, cv::INTER_AREA);
  cv::Mat picture;
  cv::cvtColor(cells, picture, cv::COLOR_GRAY2BGR);
  std::vector<cv::Point> path;
  for_each_pair(map, [&](const mrpt::poses::CPose3D& pose, const mrpt::obs::CSensoryFrame&) {
    const double pixels = scale / static_cast<double>(grid.getResolution());
    path.emplace_back(static_cast<int>((pose.x() - static_cast<double>(grid.getXMin())) * pixels),
                      static_cast<int>((static_cast<double>(grid.getYMax()) - pose.y()) * pixels));
  });
  cv::polylines(picture, path, false, cv::Scalar(0xb2, 0x72, 0x00), 1, cv::LINE_AA);
  std::vector<std::uint8_t> png;
  if (!cv::imencode(".png", picture, png)) png.clear();
  return png;
}

}  // namespace libslam
