#pragma once
// A raster of the surfaces that were seen from a stretch of path, and the search of a pose in it.
//
// Every cell knows how near the next surface is, value = exp(-d^2 / 2 sigma^2), and whether a beam
// went through it. A view, a set of points, is laid onto the raster at a pose; the share of its
// points near a surface supports the pose, the share in cells that beams went through contradicts
// it. The search is exhaustive on the raster: the maximum of `value` over blocks of cells bounds
// what any shift within a block can reach, so that most blocks are never looked into. Sources:
// Olson, "Real-time correlative scan matching", ICRA 2009; Hess et al., "Real-time loop closure in
// 2D LIDAR SLAM", ICRA 2016 (the bound).

#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace libslam {

/// What a scanner saw from one place, in the frame of the raster [m].
struct SurfaceScan {
  Eigen::Vector2d origin;
  std::vector<Eigen::Vector2d> points;
};

/// How a view lies on a raster; shares of its points.
struct ViewScore {
  double support = 0.0;       ///< mean value
  double contradicted = 0.0;  ///< where beams went through
  double unknown = 0.0;       ///< where nothing was seen
};

struct PoseWindow {
  double xy = 0.0;       ///< half width [m]
  double heading = 0.0;  ///< half width [rad]
};

/// Where a view fits best.
struct SurfaceMatch {
  Eigen::Vector3d T_grid_view;  ///< x [m], y [m], phi [rad]
  ViewScore score;
  double rival = 0.0;  ///< of the best pose elsewhere, as if as much were known there
};

class SurfaceGrid {
 public:
  using Judge = std::function<bool(const SurfaceMatch&)>;
  /// Row by row: y, then x.
  using Raster = Eigen::Matrix<unsigned char, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// Throws std::invalid_argument if there is no point at all.
  explicit SurfaceGrid(std::span<const SurfaceScan> scans);

  ViewScore score(std::span<const Eigen::Vector2d> view, const Eigen::Vector3d& T_grid_view) const;
  /// The best pose in the window around `T_grid_view`; nothing if none has the support
  /// `min_support`. Rivals are told if they come nearer than `margin`, and only of a match that is
  /// worth it: they cost the most.
  std::optional<SurfaceMatch> search(std::span<const Eigen::Vector2d> view,
                                     const Eigen::Vector3d& T_grid_view, const PoseWindow& window,
                                     double min_support, double margin,
                                     const Judge& worth_rivals) const;
  /// Climbs from `T_grid_view` to the best pose nearby.
  Eigen::Vector3d refine(std::span<const Eigen::Vector2d> view,
                         const Eigen::Vector3d& T_grid_view) const;

 private:
  /// A rotated view, in cells; the same for all shifts.
  struct Turned {
    double heading;
    std::vector<Eigen::Vector2i> cells;
  };
  /// Shifts [x, x + width) x [y, y + width) of a turned view; `sum` of one shift, or its bound.
  struct Block {
    int sum;
    std::size_t turned;
    int x, y;
  };
  /// The largest value among `width` x `width` cells that begin at a cell, with a border of as many
  /// cells at the low sides.
  struct Bounds {
    Bounds(int w, Raster m) : width(w), most(std::move(m)) {}
    int width;
    Raster most;
  };
  /// Shifts that come near the best one.
  struct Survey {
    int margin = 0;
    int reach = 0;  ///< largest shift along x and y [cells]
    Block best{};   ///< before one is found, the sum that it needs
    bool found = false;
    std::vector<Block> shifts;
    int cutoff() const { return best.sum - margin; }
  };

  /// Fills value_ and free_.
  void draw(std::span<const SurfaceScan> scans, int rows, int columns);
  /// Of all points of the view; -1 where that is less than `needed`.
  static int sum(const Bounds& bounds, const Turned& turned, int x, int y, int needed);
  double interpolated(std::span<const Eigen::Vector2d> view, const Eigen::Vector3d& pose) const;
  std::vector<Turned> turn(std::span<const Eigen::Vector2d> view, const Eigen::Vector3d& around,
                           double window) const;
  /// Looks into `block`, whose shifts are bounded at `level`, where that may be worth it.
  void look_into(const Block& block, std::size_t level, const std::vector<Turned>& turned,
                 Survey& survey) const;
  /// All shifts within the cutoff; `survey.best` may be known before.
  void survey(const std::vector<Turned>& turned, Survey& survey) const;

  Eigen::Vector2d corner_ = Eigen::Vector2d::Zero();  // of cell (0, 0)
  Raster value_;                                      // 0..255
  std::vector<Bounds> bounds_;                        // widest first, cells last
  Raster free_;                                       // beams went through
};

}  // namespace libslam
