#pragma once
// Straight lines in a row of points that a laser scanner saw in the order of their bearings.
//
//   break at jumps -> split at the farthest point from the chord -> fit -> part where two lines
//   meet
//   -> merge -> choose
//
// A line n(alpha)^T p = r is fitted by weighted total least squares, (S2.9) and (S2.10) in the
// Cartesian form: with the centred scatter S of the points, weights w_j = 1 / sigma^2,
//
//   alpha = 1/2 atan2(-2 S_xy, S_yy - S_xx),   r = n^T c,   c the weighted centre,
//
// turned by pi where r < 0: the normal points from the sensor to the line. The covariance comes
// from the noise of the beams across the line, sigma_j = sigma |cos(beta_j - alpha)|, with s_j the
// place of a point along the line from c,
//
//   d alpha = -sum w s_j e_j / sum w s_j^2,   d r = sum w e_j / W + (J n)^T c d alpha,
//
// plus a floor at the centre of the segment (config/parameters/scan_lines.hpp). Sums over any run
// of points are differences of running sums, so that a fit costs the same for any length. Keeps its
// memory from scan to scan.
//
// Sources: Arras & Siegwart 1997 (fit), Borges & Aldon 2004 (jumps), spec/seeds.md S2.8-S2.10.

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/config/parameters.hpp>
#include <libslam/data/extent.hpp>
#include <libslam/frontend/beam_points.hpp>

namespace libslam {

struct ExtractedLine {
  double alpha = 0.0, r = 0.0;                    ///< frame of the sensor, r >= 0
  Eigen::Matrix2d cov = Eigen::Matrix2d::Zero();  ///< of (alpha, r)
  Extent extent;
  int points = 0;
};

class LineExtraction {
 public:
  explicit LineExtraction(const ScanLinesParameters& parameters);

  /// `points`: by increasing bearing, `step` [rad] apart where no beam is missing. The lines are
  /// the longest first and valid until the next call.
  std::span<const ExtractedLine> extract(std::span<const BeamPoint> points, double step);

 private:
  /// Sums over points, all of the same weight.
  struct Sums {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    Sums operator-(const Sums& other) const;
    Sums operator+(const Sums& other) const;
  };
  struct Fit {
    double alpha, r;
    Eigen::Vector2d n, centre;
  };
  /// Points [first, last), a part of line `line`.
  struct Run {
    std::size_t first, last;
    Sums sums;
    std::size_t line;
  };
  /// What its runs have in common; no runs: merged into another one.
  struct Line {
    Sums sums;
    Fit fit;
    Extent extent;
    bool alive;
  };

  static Fit fit(const Sums& sums);
  bool breaks(const BeamPoint& before, const BeamPoint& after) const;
  void split(std::size_t first, std::size_t last);
  std::size_t farthest_from_chord(std::size_t first, std::size_t last) const;
  /// How far a point of a line with the normal `n` may be off it [m]; split_distance at most.
  double bound(const Eigen::Vector2d& n, const BeamPoint& point) const;
  void add_run(std::size_t first, std::size_t last);
  /// Runs that share a corner are parted where their lines meet.
  void part_at_corner(Run& before, Run& after) const;
  bool fits(const Fit& fit, std::size_t first, std::size_t last) const;
  bool fits(const Fit& fit, std::size_t line) const;
  /// How far apart the ends of two beams may lie where a surface ends [m].
  double spacing(const BeamPoint& point, const Fit& fit) const;
  void include(Line& line, const Run& run) const;
  void merge_across_gaps();
  bool merge(std::size_t into, std::size_t other);
  Fit without_tilt(std::size_t line) const;
  ExtractedLine finish(std::size_t line) const;

  ScanLinesParameters parameters_;
  std::span<const BeamPoint> points_;
  double step_ = 0.0;
  std::vector<Sums> sums_;         // over the points before each one
  std::vector<std::size_t> ends_;  // of runs that wait for their split
  std::vector<Run> runs_;
  std::vector<Line> merged_;
  std::vector<ExtractedLine> lines_;
};

}  // namespace libslam
