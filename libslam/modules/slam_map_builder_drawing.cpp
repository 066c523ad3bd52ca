#include <algorithm>
#include <stdexcept>

#include <Eigen/Dense>  // before any use of asEigen()
#include <mrpt/img/CImage.h>
#include <mrpt/maps/COccupancyGridMap2D.h>

#include <libslam/modules/pose_pdf.hpp>
#include <libslam/modules/slam_map_builder.hpp>
#include <libslam/modules/slam_map_builder_impl.hpp>

namespace libslam {

namespace {

using mrpt::img::TColor;
using Point = Eigen::Vector2d;

/// The world seen from above: x to the right, y up.
class Canvas {
 public:
  /// A white sheet that shows all points.
  explicit Canvas(const std::vector<Point>& points) {
    constexpr double kMargin = 1.0, kPixels = 1000.0;  // [m], along the longer side
    const Eigen::Map<const Eigen::Matrix2Xd> all(points.front().data(), 2,
                                                 static_cast<Eigen::Index>(points.size()));
    low_ = all.rowwise().minCoeff().array() - kMargin;
    const Point size = all.rowwise().maxCoeff().array() + kMargin - low_.array();
    per_metre_ = kPixels / size.maxCoeff();
    height_ = size.y() * per_metre_;
    image_.resize(static_cast<unsigned>(size.x() * per_metre_), static_cast<unsigned>(height_),
                  mrpt::img::CH_RGB);
    image_.filledRectangle(0, 0, static_cast<int>(image_.getWidth()),
                           static_cast<int>(image_.getHeight()), TColor::white());
  }

  /// A sheet with the grid on it.
  explicit Canvas(const mrpt::maps::COccupancyGridMap2D& grid)
      : low_(grid.getXMin(), grid.getYMin()), per_metre_(1.0 / grid.getResolution()) {
    grid.getAsImage(image_, false, true);
    height_ = static_cast<double>(image_.getHeight());
  }

  void draw_line(const Point& from, const Point& to, const TColor& color) {
    const Point a = pixel(from), b = pixel(to);
    image_.line(static_cast<int>(a.x()), static_cast<int>(a.y()), static_cast<int>(b.x()),
                static_cast<int>(b.y()), color);
  }

  /// The 2-sigma ellipse of a position.
  void draw_ellipse(const Point& mean, const Eigen::Matrix2d& cov, const TColor& color) {
    const Point centre = pixel(mean);
    mrpt::math::CMatrixDouble22 in_pixels;
    in_pixels.asEigen() = per_metre_ * per_metre_ * cov;
    in_pixels(0, 1) *= -1.0;  // y points down
    in_pixels(1, 0) *= -1.0;
    constexpr double kDot = 1.0;  // [pixel], so that what is known well can be seen
    in_pixels(0, 0) += kDot;
    in_pixels(1, 1) += kDot;
    image_.ellipseGaussian(in_pixels, centre.x(), centre.y(), 2.0, color);
  }

  bool save(const std::string& file) const { return image_.saveToFile(file); }

 private:
  Point pixel(const Point& p) const {
    return {(p.x() - low_.x()) * per_metre_, height_ - 1.0 - (p.y() - low_.y()) * per_metre_};
  }

  mrpt::img::CImage image_;
  Point low_;
  double per_metre_ = 1.0, height_ = 0.0;
};

std::vector<Point> positions(const mrpt::maps::CSimpleMap& key_frames) {
  std::vector<Point> path;
  for (const auto& [pose, frame] : key_frames) {
    const mrpt::poses::CPose3D mean = pose->getMeanVal();
    path.emplace_back(mean.x(), mean.y());
  }
  return path;
}

}  // namespace

void SlamMapBuilder::saveCurrentEstimationToImage(const std::string& file, bool) {
  const std::lock_guard lock(critical_);
  const std::vector<LandmarkEstimate> landmarks = impl_->feed.filter().landmarks();
  const auto robot = to_pose_pdf(impl_->feed.last());
  std::vector<Point> path = positions(impl_->maps.key_frames());
  path.emplace_back(robot.mean.x(), robot.mean.y());
  std::vector<Point> all = path;
  for (const LandmarkEstimate& landmark : landmarks) all.emplace_back(landmark.mean.head<2>());

  const auto grid = impl_->maps.metric_map().mapByClass<mrpt::maps::COccupancyGridMap2D>();
  Canvas canvas = grid ? Canvas(*grid) : Canvas(all);
  for (std::size_t i = 1; i < path.size(); ++i)
    canvas.draw_line(path[i - 1], path[i], TColor::red());
  for (const LandmarkEstimate& landmark : landmarks)
    canvas.draw_ellipse(landmark.mean.head<2>(), landmark.cov.topLeftCorner<2, 2>(),
                        TColor::blue());
  const Eigen::Matrix2d cov_robot = robot.cov.asEigen().topLeftCorner<2, 2>();
  canvas.draw_ellipse(path.back(), cov_robot, TColor::green());
  if (!canvas.save(file)) throw std::runtime_error(file + ": cannot be written");
}

}  // namespace libslam
