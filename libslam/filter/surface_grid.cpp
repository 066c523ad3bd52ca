#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

#include <libslam/filter/surface_grid.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

namespace {

constexpr double kCell = 0.1;                     // [m]
constexpr double kSigma = 0.12;                   // of a point from its surface [m]
constexpr int kSurface = 20;                      // larger values belong to a surface
constexpr double kMargin = 1.0;                   // around all points [m]
constexpr std::array kWidths = {16, 8, 4, 2, 1};  // of blocks [cells]
constexpr double kTurn = 0.0131;                  // from heading to heading [rad]: a cell in 7.6 m
// A rival may lie where less was seen: it is looked for so far below the margin and judged by what
// is known there.
constexpr double kHidden = 0.15;
constexpr double kMostUnknown = 0.5;
constexpr std::size_t kMostRivals = 12;
constexpr double kNearXY = 0.5;          // poses this near are the same place [m]
constexpr double kNearHeading = 0.1396;  // and this near in heading [rad]

cv::Point cell_of(const Eigen::Vector2d& corner, const Eigen::Vector2d& p) {
  return {static_cast<int>(std::floor((p.x() - corner.x()) / kCell)),
          static_cast<int>(std::floor((p.y() - corner.y()) / kCell))};
}

bool inside(const SurfaceGrid::Raster& raster, int x, int y) {
  return x >= 0 && y >= 0 && x < raster.cols() && y < raster.rows();
}

/// The same memory.
cv::Mat1b as_image(SurfaceGrid::Raster& raster) {
  return {static_cast<int>(raster.rows()), static_cast<int>(raster.cols()), raster.data()};
}

}  // namespace

SurfaceGrid::SurfaceGrid(std::span<const SurfaceScan> scans) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  for (const SurfaceScan& scan : scans) {
    low = low.cwiseMin(scan.origin);
    high = high.cwiseMax(scan.origin);
    for (const Eigen::Vector2d& p : scan.points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  if (!low.allFinite()) throw std::invalid_argument("a raster of surfaces needs points");
  corner_ = low - Eigen::Vector2d::Constant(kMargin);
  const cv::Point size = cell_of(corner_, high + Eigen::Vector2d::Constant(kMargin));
  draw(scans, size.y + 1, size.x + 1);
  for (const int width : kWidths) {
    cv::Mat1b padded;
    cv::copyMakeBorder(as_image(value_), padded, width, 0, width, 0, cv::BORDER_CONSTANT,
                       cv::Scalar(0));
    Bounds& bounds = bounds_.emplace_back(width, Raster(padded.rows, padded.cols));
    cv::dilate(padded, as_image(bounds.most), cv::Mat1b::ones(width, width), cv::Point(0, 0), 1,
               cv::BORDER_CONSTANT, cv::Scalar(0));
  }
}

void SurfaceGrid::draw(std::span<const SurfaceScan> scans, int rows, int columns) {
  cv::Mat1b empty(rows, columns, static_cast<unsigned char>(255));
  free_.setZero(rows, columns);
  cv::Mat1b free = as_image(free_);
  for (const SurfaceScan& scan : scans)
    for (const Eigen::Vector2d& p : scan.points) {
      const cv::Point cell = cell_of(corner_, p);
      cv::line(free, cell_of(corner_, scan.origin), cell, cv::Scalar(1));
      empty(cell) = 0;
    }
  cv::Mat1f distance;
  cv::distanceTransform(empty, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  value_.resize(rows, columns);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const double d = static_cast<double>(distance(y, x)) * kCell / kSigma;
      value_(y, x) = static_cast<unsigned char>(std::lround(255.0 * std::exp(-0.5 * d * d)));
      if (value_(y, x) > kSurface) free_(y, x) = 0;
    }
}

ViewScore SurfaceGrid::score(std::span<const Eigen::Vector2d> view,
                             const Eigen::Vector3d& T_grid_view) const {
  ViewScore score;
  if (view.empty()) return score;
  for (const Eigen::Vector2d& p : view) {
    const cv::Point cell = cell_of(corner_, transform_point(T_grid_view, p));
    if (!inside(value_, cell.x, cell.y)) {
      score.unknown += 1.0;
      continue;
    }
    score.support += value_(cell.y, cell.x) / 255.0;
    if (free_(cell.y, cell.x) != 0)
      score.contradicted += 1.0;
    else if (value_(cell.y, cell.x) <= kSurface)
      score.unknown += 1.0;
  }
  const double n = static_cast<double>(view.size());
  return {score.support / n, score.contradicted / n, score.unknown / n};
}

int SurfaceGrid::sum(const Bounds& bounds, const Turned& turned, int x, int y, int needed) {
  int missed = 255 * static_cast<int>(turned.cells.size()) - needed;
  for (const Eigen::Vector2i& cell : turned.cells) {
    const int column = cell.x() + x + bounds.width, row = cell.y() + y + bounds.width;
    missed -= inside(bounds.most, column, row) ? 255 - bounds.most(row, column) : 255;
    if (missed < 0) return -1;
  }
  return needed + missed;
}

std::vector<SurfaceGrid::Turned> SurfaceGrid::turn(std::span<const Eigen::Vector2d> view,
                                                   const Eigen::Vector3d& around,
                                                   double window) const {
  std::vector<Turned> all;
  const int steps = static_cast<int>(std::ceil(window / kTurn));
  for (int k = -steps; k <= steps; ++k) {
    Turned& turned = all.emplace_back();
    turned.heading = around.z() + k * kTurn;
    turned.cells.reserve(view.size());
    for (const Eigen::Vector2d& p : view) {
      const cv::Point cell =
          cell_of(corner_, transform_point({around.x(), around.y(), turned.heading}, p));
      turned.cells.emplace_back(cell.x, cell.y);
    }
  }
  return all;
}

void SurfaceGrid::look_into(const Block& block, std::size_t level,
                            const std::vector<Turned>& turned, Survey& survey) const {
  if (block.sum < survey.cutoff()) return;
  const int width = bounds_[level].width;
  if (width == 1) {
    if (std::max(std::abs(block.x), std::abs(block.y)) > survey.reach) return;
    survey.shifts.push_back(block);
    if (!survey.found || block.sum > survey.best.sum) survey.best = block;
    survey.found = true;
    return;
  }
  const Bounds& finer = bounds_[level + 1];
  for (int y = block.y; y < block.y + width; y += finer.width)
    for (int x = block.x; x < block.x + width; x += finer.width)
      look_into({sum(finer, turned[block.turned], x, y, survey.cutoff()), block.turned, x, y},
                level + 1, turned, survey);
}

namespace {

/// Support by what is known; a view that lies on little of it proves nothing.
double fit(const ViewScore& score) {
  return score.unknown > kMostUnknown ? 0.0 : score.support / (1.0 - score.unknown);
}

/// The best shifts away from `best` and from each other, as poses.
template <class Block, class Turned>
std::vector<Eigen::Vector3d> rivals(std::vector<Block> shifts, const Block& best,
                                    const std::vector<Turned>& turned,
                                    const Eigen::Vector3d& around) {
  const auto is_near = [&](const Block& a, const Block& b) {
    return kCell * std::hypot(a.x - b.x, a.y - b.y) <= kNearXY &&
           std::abs(turned[a.turned].heading - turned[b.turned].heading) <= kNearHeading;
  };
  std::stable_sort(shifts.begin(), shifts.end(),
                   [](const Block& a, const Block& b) { return a.sum > b.sum; });
  std::vector<Block> apart{best};
  for (const Block& shift : shifts) {
    if (apart.size() > kMostRivals) break;
    if (std::none_of(apart.begin(), apart.end(),
                     [&](const Block& other) { return is_near(shift, other); }))
      apart.push_back(shift);
  }
  std::vector<Eigen::Vector3d> poses;
  for (std::size_t i = 1; i < apart.size(); ++i)
    poses.emplace_back(around.x() + kCell * apart[i].x, around.y() + kCell * apart[i].y,
                       turned[apart[i].turned].heading);
  return poses;
}

}  // namespace

void SurfaceGrid::survey(const std::vector<Turned>& turned, Survey& survey) const {
  const Bounds& coarse = bounds_.front();
  std::vector<Block> blocks;
  for (std::size_t k = 0; k < turned.size(); ++k)
    for (int y = -survey.reach; y <= survey.reach; y += coarse.width)
      for (int x = -survey.reach; x <= survey.reach; x += coarse.width)
        if (const int bound = sum(coarse, turned[k], x, y, survey.cutoff());
            bound >= survey.cutoff())
          blocks.push_back({bound, k, x, y});
  std::stable_sort(blocks.begin(), blocks.end(),
                   [](const Block& a, const Block& b) { return a.sum > b.sum; });
  for (const Block& block : blocks) look_into(block, 0, turned, survey);
}

std::optional<SurfaceMatch> SurfaceGrid::search(std::span<const Eigen::Vector2d> view,
                                                const Eigen::Vector3d& T_grid_view,
                                                const PoseWindow& window, double min_support,
                                                double margin, const Judge& worth_rivals) const {
  if (view.empty()) return std::nullopt;
  const double full = 255.0 * static_cast<double>(view.size());
  const std::vector<Turned> turned = turn(view, T_grid_view, window.heading);
  Survey near;
  near.reach = static_cast<int>(std::lround(window.xy / kCell));
  near.best.sum = static_cast<int>(min_support * full);
  survey(turned, near);
  if (!near.found) return std::nullopt;
  const Block best = near.best;
  SurfaceMatch match;
  match.T_grid_view =
      refine(view, {T_grid_view.x() + kCell * best.x, T_grid_view.y() + kCell * best.y,
                    wrap_angle(turned[best.turned].heading)});
  match.score = score(view, match.T_grid_view);
  if (!worth_rivals(match)) return match;
  // Rivals are many more than what may be the best one: a second survey, where there is one.
  near.shifts.clear();
  near.margin = static_cast<int>((margin + kHidden) * full);
  survey(turned, near);
  double rival_fit = 0.0;
  for (const Eigen::Vector3d& rival : rivals(near.shifts, best, turned, T_grid_view))
    rival_fit = std::max(rival_fit, fit(score(view, rival)));
  match.rival = (1.0 - match.score.unknown) * rival_fit;
  return match;
}

double SurfaceGrid::interpolated(std::span<const Eigen::Vector2d> view,
                                 const Eigen::Vector3d& pose) const {
  double sum = 0.0;
  for (const Eigen::Vector2d& p : view) {
    const Eigen::Vector2d q =
        (transform_point(pose, p) - corner_) / kCell - Eigen::Vector2d::Constant(0.5);
    const int x = static_cast<int>(std::floor(q.x())), y = static_cast<int>(std::floor(q.y()));
    if (!inside(value_, x, y) || !inside(value_, x + 1, y + 1)) continue;
    const double u = q.x() - x, v = q.y() - y;
    sum += (1 - v) * ((1 - u) * value_(y, x) + u * value_(y, x + 1)) +
           v * ((1 - u) * value_(y + 1, x) + u * value_(y + 1, x + 1));
  }
  return sum;
}

Eigen::Vector3d SurfaceGrid::refine(std::span<const Eigen::Vector2d> view,
                                    const Eigen::Vector3d& T_grid_view) const {
  Eigen::Vector3d best = T_grid_view;
  double top = interpolated(view, best);
  for (double scale = 1.0; scale > 0.1; scale *= 0.5) {
    const Eigen::Vector3d step = scale * Eigen::Vector3d(0.5 * kCell, 0.5 * kCell, 0.5 * kTurn);
    for (bool moved = true; moved;) {
      moved = false;
      for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
          Eigen::Vector3d trial = best;
          trial[axis] += sign * step[axis];
          if (const double value = interpolated(view, trial); value > top) {
            best = trial;
            top = value;
            moved = true;
          }
        }
    }
  }
  best.z() = wrap_angle(best.z());
  return best;
}

}  // namespace libslam
