// Walls and scale over a grid of two scans, looked at pixel by pixel.

#include <cmath>

#include <gtest/gtest.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <opencv2/imgcodecs.hpp>

#include <libslam/io/exporters/map_picture.hpp>
#include <libslam/io/exporters/simple_map.hpp>
#include <libslam/map/line_segment.hpp>

namespace libslam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

LandmarkEstimate line(double alpha, double r, std::optional<Extent> extent) {
  return {7, "line", Eigen::Vector2d(alpha, r), Eigen::Matrix2d::Identity(), 3, extent};
}

TEST(LineSegment, EndsAreLeftAndRightOfTheFootOfTheNormal) {
  const auto wall = segment_of(line(M_PI / 2, 2.0, Extent{-1.0, 3.0}));
  ASSERT_TRUE(wall);
  EXPECT_TRUE(wall->from.isApprox(Eigen::Vector2d(1, 2), 1e-12)) << wall->from.transpose();
  EXPECT_TRUE(wall->to.isApprox(Eigen::Vector2d(-3, 2), 1e-12)) << wall->to.transpose();
  // Its other side: the normal turned by half a turn, r and the extent with the other sign.
  const auto other = segment_of(line(-M_PI / 2, -2.0, Extent{-3.0, 1.0}));
  EXPECT_TRUE(other->from.isApprox(wall->to, 1e-12));
  EXPECT_FALSE(segment_of(line(0, 1, std::nullopt)));
  LandmarkEstimate point = line(0, 1, Extent{0, 1});
  point.type = "point";
  EXPECT_FALSE(segment_of(point));
}

/// A room of 8 x 5 m that is free inside, with a margin of unknown cells.
COccupancyGridMap2D room() {
  COccupancyGridMap2D grid(-14.0F, 14.0F, -12.5F, 12.5F, 0.05F);
  for (int cy = 0; cy < static_cast<int>(grid.getSizeY()); ++cy)
    for (int cx = 0; cx < static_cast<int>(grid.getSizeX()); ++cx) {
      const double x = static_cast<double>(grid.idx2x(cx)), y = static_cast<double>(grid.idx2y(cy));
      grid.setCell(cx, cy, std::abs(x) < 4.0 && std::abs(y) < 2.5 ? 0.95F : 0.5F);
    }
  return grid;
}

mrpt::maps::CSimpleMap drive() {
  SimpleMapWriter writer;
  for (const double x : {-2.0, 0.0, 2.0})
    writer.add(Eigen::Vector3d(x, -1.0, 0.0), Eigen::Matrix3d::Identity(),
               mrpt::obs::CSensoryFrame::Create());
  return writer.map();
}

cv::Mat picture_of(const LandmarkMap& landmarks, int max_side) {
  return cv::imdecode(draw_map(room(), drive(), landmarks, max_side), cv::IMREAD_COLOR);
}

/// Pixels darker than a third of white.
int dark_pixels(const cv::Mat& picture, const cv::Rect& part) {
  int count = 0;
  for (int row = part.y; row < part.y + part.height; ++row)
    for (int column = part.x; column < part.x + part.width; ++column) {
      const auto& p = picture.at<cv::Vec3b>(row, column);
      if (p[0] < 85 && p[1] < 85 && p[2] < 85) ++count;
    }
  return count;
}

TEST(MapPicture, IsCutToWhatWasSeenAndBounded) {
  const cv::Mat picture = picture_of({}, 400);
  ASSERT_FALSE(picture.empty());
  // 8 x 5 m of cells, half a metre around, and the margins of the axes.
  EXPECT_NEAR(picture.cols, 400 + 88, 2);
  EXPECT_NEAR(picture.rows, 400 * 6.0 / 9.0 + 82, 4);
  const auto& free = picture.at<cv::Vec3b>(picture.rows / 2, picture.cols / 2);
  EXPECT_GT(free[0], 245);
  const auto& unknown = picture.at<cv::Vec3b>(30, 70);
  EXPECT_LT(unknown[0], 245);
  EXPECT_TRUE(draw_map(COccupancyGridMap2D(-1.0F, 1.0F, -1.0F, 1.0F, 0.1F), {}, {}).empty());
}

TEST(MapPicture, WallsAreThinDarkSegments) {
  LandmarkMap walls;
  walls.add(line(M_PI / 2, 2.0, Extent{-3.0, 3.0}));
  const cv::Mat with = picture_of(walls, 400), without = picture_of({}, 400);
  ASSERT_EQ(with.size(), without.size());
  const double pixels_per_metre = 400 / 9.0;
  const cv::Rect inside(66, 26, with.cols - 66 - 26, with.rows - 26 - 60);
  const int drawn = dark_pixels(with, inside) - dark_pixels(without, inside);
  const double length = 6.0 * pixels_per_metre;
  EXPECT_GT(drawn, 0.9 * length);
  EXPECT_LT(drawn, 3.0 * length);
  const int row = 24 + static_cast<int>(std::lround(1.0 * pixels_per_metre));  // y = 2, top at 3
  EXPECT_GT(dark_pixels(with, {66, row - 2, inside.width, 5}), 0.9 * length);
}

}  // namespace
}  // namespace libslam
