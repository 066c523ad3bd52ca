#pragma once
// Loops that association no longer closes, because the drift is larger than the filter believes.
//
// A view is what the scanner saw on the last metres of the path. Where the robot comes near a
// stretch that it left behind long ago, the view is searched in the raster of that stretch, in a
// window around the estimate that the covariance does not narrow: it is the one that is wrong. A
// match counts if it supports enough of the view, no rival elsewhere in the window comes close, and
// old beams did not go through what is seen now. A loop is closed once matches from places apart
// agree with the way driven between them; then the relative poses of all of them are one
// measurement of the delayed poses, linearized repeatedly. A wrong closure is worse than none.
//
// Source of the mutual test: Mangelson et al., "Pairwise consistent measurement set maximization
// for robust multi-robot map merging", ICRA 2018.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <libslam/filter/ekf.hpp>
#include <libslam/filter/iterated_update.hpp>
#include <libslam/filter/path_memory.hpp>
#include <libslam/filter/surface_grid.hpp>

namespace libslam {

struct LoopClosureOptions {
  double min_way = 0.0;  ///< from an old place to the view [m]
  PoseWindow window;
  double min_support = 0.0, min_margin = 0.0, max_contradicted = 1.0;  ///< shares of the view
  double joint_gate = 0.0;  ///< of the squared misfit of two matches, 3 degrees of freedom
  int confirmations = 1;    ///< matches that must agree
  double confirmation_distance = 0.0;  ///< between the places of these [m of way]
};

/// A view that was found again.
struct LoopMatch {
  std::size_t old_place = 0, new_place = 0;  ///< of PathMemory::places
  Eigen::Vector3d T_old_new;                 ///< x [m], y [m], phi [rad]
  Eigen::Vector3d T_estimate_match;          ///< the correction that it asks for, not a small one
};

/// What became of the searches.
struct LoopCounts {
  std::int64_t in_place = 0;  ///< views that fit without a correction
  std::int64_t searches = 0, matches = 0;
  std::int64_t ambiguous = 0, contradicted = 0;  ///< matches that do not count
  std::int64_t closures = 0;
};

class LoopClosure {
 public:
  /// Throws std::invalid_argument without a window or with less than one confirmation.
  explicit LoopClosure(const LoopClosureOptions& options);

  /// Looks from the planar `pose` at `points` [m], in the frame of the robot; `kept`: a delayed
  /// pose not far behind. True: a loop was closed, and the state has changed.
  bool look(GaussianState& state, Ekf& ekf, BlockId pose, BlockId kept,
            std::span<const Eigen::Vector2d> points);

  /// The robot was put elsewhere.
  void restart();

  const PathMemory& path() const { return path_; }
  /// The matches behind all closures, to be compared with a truth.
  std::span<const LoopMatch> closed() const { return closed_; }
  const LoopCounts& counts() const { return counts_; }
  /// The same by name, for run.json.
  std::map<std::string, double> figures() const;

 private:
  /// The raster of a stretch, its frame the middle place, and how its ends stood to each other.
  struct StretchGrid {
    Eigen::Vector3d T_first_last;
    SurfaceGrid grid;
  };
  struct NearStretch {
    double distance;  ///< from the present pose to the path [m]
    std::size_t stretch;
  };

  /// Old stretches near the present pose, the nearest first.
  std::vector<NearStretch> near_stretches(const GaussianState& state) const;
  const SurfaceGrid& grid(const GaussianState& state, std::size_t stretch);
  /// Frees the rasters of all other stretches.
  void keep_grids(std::span<const NearStretch> near);
  /// Matches of the present view that count.
  std::vector<LoopMatch> find(const GaussianState& state);
  bool in_place(const SurfaceGrid& raster, std::span<const Eigen::Vector2d> view,
                const Eigen::Vector3d& T_old_new) const;
  /// The view on `raster`, from the two places of `there` as they are estimated, if it fits
  /// elsewhere and counts.
  std::optional<LoopMatch> match(std::span<const Eigen::Vector2d> view, const SurfaceGrid& raster,
                                 LoopMatch there);
  bool agree(const GaussianState& state, const LoopMatch& a, const LoopMatch& b) const;
  /// `match` and those before it that agree with it, each from another place.
  std::vector<LoopMatch> agreeing(const GaussianState& state, const LoopMatch& match) const;
  bool close(GaussianState& state, Ekf& ekf, BlockId pose, std::span<const LoopMatch> matches);

  LoopClosureOptions options_;
  PathMemory path_;
  std::map<std::size_t, StretchGrid> grids_;  // by stretch
  std::vector<LoopMatch> pending_, closed_;
  LoopCounts counts_;
  IteratedUpdate update_;
};

}  // namespace libslam
