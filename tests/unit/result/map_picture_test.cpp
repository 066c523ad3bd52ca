// Walls and scale over a grid of two scans, looked at pixel by pixel.

#include <cmath>

#include <gtest/gtest.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <libslam/io/exporters/map_picture.hpp>
#include <libslam/io/exporters/simple_map.hpp>
#include <libslam/map/line_segment.hpp>

namespace libslam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

LandmarkEstimate line(double alpha, double r, std::optional<Extent> extent, std::int64_t id = 7) {
  return {id, "line", Eigen::Vector2d(alpha, r), Eigen::Matrix2d::Identity(), 3, extent};
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

/// How much darker a part is than in the other picture, in pixels from white to black.
double ink(const cv::Mat& picture, const cv::Mat& without, const cv::Rect& part) {
  const cv::Mat darker = without(part) - picture(part);  // saturates at 0
  const cv::Scalar sum = cv::sum(darker);
  return (sum[0] + sum[1] + sum[2]) / (3.0 * 255.0);
}

TEST(MapPicture, IsCutToWhatWasSeenAndBounded) {
  const cv::Mat picture = picture_of({}, 300);
  ASSERT_FALSE(picture.empty());
  // 8 x 5 m of cells, half a metre around, and the margins of the axes.
  EXPECT_NEAR(picture.cols, 300 + 88, 2);
  EXPECT_NEAR(picture.rows, 300 * 6.0 / 9.0 + 82, 4);
  const auto& free = picture.at<cv::Vec3b>(picture.rows / 2, picture.cols / 2);
  EXPECT_GT(free[0], 245);
  const auto& unknown = picture.at<cv::Vec3b>(30, 70);
  EXPECT_LT(unknown[0], 245);
  EXPECT_TRUE(draw_map(COccupancyGridMap2D(-1.0F, 1.0F, -1.0F, 1.0F, 0.1F), {}, {}).empty());
}

TEST(MapPicture, WallsAreThinDarkSegments) {
  LandmarkMap walls;
  walls.add(line(M_PI / 2, 2.0, Extent{-3.0, 3.0}));
  const cv::Mat with = picture_of(walls, 300), without = picture_of({}, 300);
  ASSERT_EQ(with.size(), without.size());
  constexpr double kPixelsPerMetre = 300 / 9.0, kLength = 6.0 * kPixelsPerMetre;
  const cv::Rect everywhere(0, 0, with.cols, with.rows);
  const double drawn = ink(with, without, everywhere);
  EXPECT_GT(drawn, 0.6 * kLength);
  EXPECT_LT(drawn, 2.0 * kLength);                                      // a pixel or two wide
  const int row = 24 + static_cast<int>(std::lround(kPixelsPerMetre));  // y = 2, the top at 3
  EXPECT_NEAR(ink(with, without, {0, row - 3, with.cols, 7}), drawn, 1e-9);
}

TEST(MapPicture, AStrayWallNeitherStretchesTheSheetNorLeavesIt) {
  LandmarkMap walls;
  walls.add(line(0.0, 500.0, Extent{-1.0, 1.0}));
  walls.add(line(M_PI / 2, 0.5, Extent{-400.0, 0.0}, 8));
  const cv::Mat picture = picture_of(walls, 300);
  ASSERT_FALSE(picture.empty());
  EXPECT_LE(picture.cols, 300 + 88 + 1);
  EXPECT_GT(picture.rows, 150);
  const auto& margin = picture.at<cv::Vec3b>(picture.rows / 2, picture.cols - 4);
  EXPECT_EQ(margin, cv::Vec3b(255, 255, 255));
}

}  // namespace
}  // namespace libslam
