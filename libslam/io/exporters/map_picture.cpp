#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <Eigen/Geometry>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <libslam/io/exporters/map_picture.hpp>
#include <libslam/map/line_segment.hpp>

namespace libslam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::maps::CSimpleMap;
using Point = cv::Point;

// Blue, green, red. Path as in the plots of the report.
const cv::Scalar kInk(0x28, 0x23, 0x1f), kPath(0xb2, 0x72, 0x00), kPaper(0xff, 0xff, 0xff),
    kRule(0xc8, 0xc8, 0xc8), kTree(0x00, 0x5e, 0xd5);

constexpr int kLeft = 64, kRight = 24, kTop = 24, kBottom = 58;  // margins [pixel]
constexpr int kShift = 4;  // fractional bits of coordinates that OpenCV draws

/// The part of the world that is drawn, and where.
struct Sheet {
  Eigen::AlignedBox2d box;  ///< [m]
  double pixels_per_metre;

  int width() const { return static_cast<int>(std::lround(box.sizes().x() * pixels_per_metre)); }
  int height() const { return static_cast<int>(std::lround(box.sizes().y() * pixels_per_metre)); }
  double column(double x) const { return kLeft + (x - box.min().x()) * pixels_per_metre; }
  double row(double y) const { return kTop + (box.max().y() - y) * pixels_per_metre; }
  /// With kShift fractional bits.
  Point fine(const Eigen::Vector2d& p) const {
    constexpr double kUnits = 1 << kShift;
    return {static_cast<int>(std::lround(column(p.x()) * kUnits)),
            static_cast<int>(std::lround(row(p.y()) * kUnits))};
  }
};

/// The cells that say anything, the key poses, and walls not far from these. A few stray returns do
/// not count: a row or column needs several known cells.
Eigen::AlignedBox2d seen_part(const COccupancyGridMap2D& grid,
                              const std::vector<Eigen::Vector2d>& path,
                              const LandmarkMap& landmarks) {
  constexpr int kFew = 4;
  constexpr float kSays = 0.1F;
  const auto width = static_cast<int>(grid.getSizeX()), height = static_cast<int>(grid.getSizeY());
  std::vector<int> columns(static_cast<std::size_t>(width)), rows(static_cast<std::size_t>(height));
  for (int cy = 0; cy < height; ++cy)
    for (int cx = 0; cx < width; ++cx)
      if (std::abs(grid.getCell(cx, cy) - 0.5F) > kSays) {
        ++columns[static_cast<std::size_t>(cx)];
        ++rows[static_cast<std::size_t>(cy)];
      }
  Eigen::AlignedBox2d box;
  const double cell = static_cast<double>(grid.getResolution());
  const auto extend = [&](const std::vector<int>& counts, Eigen::Index axis, double origin) {
    for (std::size_t i = 0; i < counts.size(); ++i)
      if (counts[i] >= kFew) {
        const double at = origin + (static_cast<double>(i) + 0.5) * cell;
        box.min()[axis] = std::min(box.min()[axis], at);
        box.max()[axis] = std::max(box.max()[axis], at);
      }
  };
  extend(columns, 0, static_cast<double>(grid.getXMin()));
  extend(rows, 1, static_cast<double>(grid.getYMin()));
  for (const Eigen::Vector2d& p : path) box.extend(p);
  if (box.isEmpty()) return box;
  constexpr double kFarthest = 0.15;  // of the larger side: a stray wall is not worth the paper
  const Eigen::Vector2d rim = Eigen::Vector2d::Constant(kFarthest * box.sizes().maxCoeff());
  const Eigen::AlignedBox2d limit(box.min() - rim, box.max() + rim);
  for (const LandmarkEstimate& landmark : landmarks)
    if (const auto wall = segment_of(landmark)) box.extend(wall->from).extend(wall->to);
  return box.intersection(limit);
}

/// The grid over the whole sheet: free white, unknown light grey, occupied grey.
cv::Mat shade(const COccupancyGridMap2D& grid, const Sheet& sheet) {
  const int width = static_cast<int>(grid.getSizeX()), height = static_cast<int>(grid.getSizeY());
  cv::Mat cells(height, width, CV_8UC1);
  constexpr double kDarkest = 110.0, kGrey = 226.0, kFree = 255.0;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const double p = static_cast<double>(grid.getCell(column, row));
      const double tone = p < 0.5 ? kDarkest + (kGrey - kDarkest) * 2.0 * p
                                  : kGrey + (kFree - kGrey) * (2.0 * p - 1.0);
      cells.at<std::uint8_t>(height - 1 - row, column) = static_cast<std::uint8_t>(tone);
    }
  const double scale = sheet.pixels_per_metre * static_cast<double>(grid.getResolution());
  cv::resize(cells, cells, {}, scale, scale, scale < 1.0 ? cv::INTER_AREA : cv::INTER_NEAREST);
  cv::Mat moved;
  const double dx = (static_cast<double>(grid.getXMin()) - sheet.box.min().x());
  const double dy = (sheet.box.max().y() - static_cast<double>(grid.getYMax()));
  const cv::Mat shift = (cv::Mat_<double>(2, 3) << 1, 0, std::round(dx * sheet.pixels_per_metre), 0,
                         1, std::round(dy * sheet.pixels_per_metre));
  cv::warpAffine(cells, moved, shift, {sheet.width(), sheet.height()}, cv::INTER_NEAREST,
                 cv::BORDER_CONSTANT, cv::Scalar(kGrey));
  cv::cvtColor(moved, moved, cv::COLOR_GRAY2BGR);
  return moved;
}

void draw_path(cv::Mat& picture, const Sheet& sheet, const std::vector<Eigen::Vector2d>& path) {
  if (path.empty()) return;
  std::vector<Point> points;
  for (const Eigen::Vector2d& p : path) points.push_back(sheet.fine(p));
  cv::polylines(picture, points, false, kPath, 1, cv::LINE_AA, kShift);
  constexpr int kRadius = 5 << kShift;
  cv::circle(picture, points.back(), kRadius, kPath, cv::FILLED, cv::LINE_AA, kShift);
  cv::circle(picture, points.front(), kRadius, kPaper, cv::FILLED, cv::LINE_AA, kShift);
  cv::circle(picture, points.front(), kRadius, kPath, 2, cv::LINE_AA, kShift);
}

void draw_landmarks(cv::Mat& picture, const Sheet& sheet, const LandmarkMap& landmarks) {
  constexpr int kRadius = 4 << kShift;
  for (const LandmarkEstimate& landmark : landmarks)
    if (const auto wall = segment_of(landmark))
      cv::line(picture, sheet.fine(wall->from), sheet.fine(wall->to), kInk, 1, cv::LINE_AA, kShift);
    else if (landmark.type == "point" && landmark.mean.size() >= 2)
      cv::circle(picture, sheet.fine(landmark.mean.head<2>()), kRadius, kTree, cv::FILLED,
                 cv::LINE_AA, kShift);
}

/// What was drawn beyond the sheet disappears under the paper around it.
void clear_margins(cv::Mat& picture, const Sheet& sheet) {
  const int bottom = kTop + sheet.height(), right = kLeft + sheet.width();
  for (const cv::Rect& margin : {cv::Rect(0, 0, picture.cols, kTop),
                                 cv::Rect(0, bottom, picture.cols, picture.rows - bottom),
                                 cv::Rect(0, 0, kLeft, picture.rows),
                                 cv::Rect(right, 0, picture.cols - right, picture.rows)})
    picture(margin).setTo(kPaper);
}

/// 1, 2 or 5 times a power of ten, at least `least`.
double round_step(double least) {
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= least) return factor * decade;
  return 10.0 * decade;
}

enum class Anchor { middle, end };

void write_text(cv::Mat& picture, const std::string& text, double x, double y, Anchor anchor) {
  constexpr double kScale = 0.42;
  int below = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kScale, 1, &below);
  const double left = x - size.width * (anchor == Anchor::middle ? 0.5 : 1.0);
  cv::putText(picture, text,
              {static_cast<int>(std::lround(left)), static_cast<int>(std::lround(y))},
              cv::FONT_HERSHEY_SIMPLEX, kScale, kInk, 1, cv::LINE_AA);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value == 0.0 ? 0.0 : value);
  return text;
}

void draw_axes(cv::Mat& picture, const Sheet& sheet) {
  const auto pixel = [](double v) { return static_cast<int>(std::lround(v)); };
  const int bottom = kTop + sheet.height(), right = kLeft + sheet.width();
  const double step = round_step(90.0 / sheet.pixels_per_metre);
  const auto first = [&](double low) { return std::ceil(low / step) * step; };
  for (double x = first(sheet.box.min().x()); x <= sheet.box.max().x(); x += step) {
    cv::line(picture, {pixel(sheet.column(x)), bottom}, {pixel(sheet.column(x)), bottom + 5}, kInk);
    write_text(picture, number(x), sheet.column(x), bottom + 18.0, Anchor::middle);
  }
  for (double y = first(sheet.box.min().y()); y <= sheet.box.max().y(); y += step) {
    cv::line(picture, {kLeft - 5, pixel(sheet.row(y))}, {kLeft, pixel(sheet.row(y))}, kInk);
    write_text(picture, number(y), kLeft - 8.0, sheet.row(y) + 4.0, Anchor::end);
  }
  cv::rectangle(picture, {kLeft, kTop}, {right, bottom}, kRule);
  write_text(picture, "x [m]", kLeft + 0.5 * sheet.width(), bottom + 40.0, Anchor::middle);
  write_text(picture, "y [m]", kLeft - 8.0, kTop - 8.0, Anchor::end);
}

/// In the lower right corner below the axis.
void draw_scale_bar(cv::Mat& picture, const Sheet& sheet) {
  const double length = round_step(0.5 * sheet.width() / sheet.pixels_per_metre / 5.0);
  const int right = kLeft + sheet.width(), row = kTop + sheet.height() + 36;
  const int left = right - static_cast<int>(std::lround(length * sheet.pixels_per_metre));
  cv::line(picture, {left, row}, {right, row}, kInk, 3);
  for (const int end : {left, right}) cv::line(picture, {end, row - 4}, {end, row + 4}, kInk, 2);
  write_text(picture, number(length) + " m", left - 8.0, row + 5.0, Anchor::end);
}

std::vector<Eigen::Vector2d> key_positions(const CSimpleMap& map) {
  std::vector<Eigen::Vector2d> path;
  for (std::size_t i = 0; i < map.size(); ++i)
    if (const auto [pose, frame] = map.get(i); pose) {
      const mrpt::poses::CPose3D mean = pose->getMeanVal();
      path.emplace_back(mean.x(), mean.y());
    }
  return path;
}

}  // namespace

std::vector<std::uint8_t> draw_map(const COccupancyGridMap2D& grid, const CSimpleMap& map,
                                   const LandmarkMap& landmarks, int max_side) {
  const std::vector<Eigen::Vector2d> path = key_positions(map);
  Eigen::AlignedBox2d box = seen_part(grid, path, landmarks);
  if (box.isEmpty()) return {};
  const Eigen::Vector2d rim =
      Eigen::Vector2d::Constant(std::max(0.5, 0.02 * box.sizes().maxCoeff()));
  box = {box.min() - rim, box.max() + rim};
  const double finest = 2.0 / static_cast<double>(grid.getResolution());
  const Sheet sheet{box, std::min(finest, max_side / box.sizes().maxCoeff())};
  cv::Mat picture(sheet.height() + kTop + kBottom, sheet.width() + kLeft + kRight, CV_8UC3, kPaper);
  cv::Mat inside = picture(cv::Rect(kLeft, kTop, sheet.width(), sheet.height()));
  shade(grid, sheet).copyTo(inside);
  draw_path(picture, sheet, path);
  draw_landmarks(picture, sheet, landmarks);
  clear_margins(picture, sheet);
  draw_axes(picture, sheet);
  draw_scale_bar(picture, sheet);
  std::vector<std::uint8_t> png;
  if (!cv::imencode(".png", picture, png)) png.clear();
  return png;
}

}  // namespace libslam
