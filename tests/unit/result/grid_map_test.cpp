// A room, scanned from three places, as a grid that MRPT reads back.

#include <cmath>

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/serialization/CArchive.h>

#include <libslam/io/exporters/grid_map.hpp>
#include <libslam/io/exporters/simple_map.hpp>

#include "sample_run.hpp"

namespace libslam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr double kHalfLength = 4.0, kHalfWidth = 2.5;

/// What a laser of 360 degrees sees of a room around the origin.
mrpt::obs::CSensoryFrame::Ptr scan_from(const Eigen::Vector3d& pose) {
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  constexpr std::size_t kBeams = 720;
  scan->aperture = static_cast<float>(2 * M_PI * (kBeams - 1) / kBeams);
  scan->maxRange = 30.0F;
  scan->resizeScan(kBeams);
  for (std::size_t i = 0; i < kBeams; ++i) {
    const double beta = pose.z() - 0.5 * static_cast<double>(scan->aperture) +
                        2 * M_PI * static_cast<double>(i) / kBeams;
    const double to_x = (std::copysign(kHalfLength, std::cos(beta)) - pose.x()) / std::cos(beta);
    const double to_y = (std::copysign(kHalfWidth, std::sin(beta)) - pose.y()) / std::sin(beta);
    scan->setScanRange(i, static_cast<float>(std::min(to_x, to_y)));
    scan->setScanRangeValidity(i, true);
  }
  auto frame = mrpt::obs::CSensoryFrame::Create();
  frame->insert(scan);
  return frame;
}

mrpt::maps::CSimpleMap room() {
  SimpleMapWriter writer;
  for (const Eigen::Vector3d& pose :
       {Eigen::Vector3d(-2, 0.5, 0.3), Eigen::Vector3d(0, -1, 1.2), Eigen::Vector3d(2, 1, -2)})
    writer.add(pose, 1e-4 * Eigen::Matrix3d::Identity(), scan_from(pose));
  return writer.map();
}

TEST(GridMap, WallsAreOccupiedTheInsideIsFreeAndTheOutsideUnknown) {
  const sample::TemporaryFolder folder("grid");
  const auto rendered = render_grid_map(room());
  ASSERT_TRUE(rendered);
  write_grid_map(folder.path() / "map.gridmap.gz", *rendered);
  mrpt::io::CFileGZInputStream in((folder.path() / "map.gridmap.gz").string());
  COccupancyGridMap2D grid;
  mrpt::serialization::archiveFrom(in) >> grid;
  EXPECT_FLOAT_EQ(grid.getResolution(), 0.05F);
  const auto free = [&](double x, double y) {
    return grid.getPos(static_cast<float>(x), static_cast<float>(y));
  };
  const auto wall = [&](double x, double y) {  // within a cell
    float lowest = 1.0F;
    for (const double dx : {-0.05, 0.0, 0.05})
      for (const double dy : {-0.05, 0.0, 0.05}) lowest = std::min(lowest, free(x + dx, y + dy));
    return lowest;
  };
  for (double t = -0.9; t < 0.95; t += 0.1) {
    EXPECT_LT(wall(t * kHalfLength, kHalfWidth), 0.3F) << t;
    EXPECT_LT(wall(t * kHalfLength, -kHalfWidth), 0.3F) << t;
    EXPECT_LT(wall(kHalfLength, t * kHalfWidth), 0.3F) << t;
    EXPECT_GT(free(0.9 * t * kHalfLength, 0.9 * t * kHalfWidth), 0.6F) << t;
  }
  EXPECT_NEAR(free(kHalfLength + 0.4, 0.0), 0.5F, 0.01F);
}

TEST(GridMap, StaysWithinItsCellsAndRange) {
  GridMapOptions options;
  options.max_cells = 2000;
  const auto coarse = render_grid_map(room(), options);
  ASSERT_TRUE(coarse);
  EXPECT_LE(coarse->getSizeX() * coarse->getSizeY(), 4000U);  // sides are rounded up
  EXPECT_GT(coarse->getResolution(), 0.05F);
  EXPECT_FALSE(render_grid_map({}));
  SimpleMapWriter without_laser;
  without_laser.add(Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(),
                    mrpt::obs::CSensoryFrame::Create());
  EXPECT_FALSE(render_grid_map(without_laser.map()));
}

TEST(GridMap, NamesTheFileThatCannotBeWritten) {
  const auto map = room();
  EXPECT_THROW(write_grid_map("/nonexistent/map.gridmap.gz", *render_grid_map(map)),
               std::runtime_error);
}

}  // namespace
}  // namespace libslam
