#pragma once
// Two laser scans from nearby places: how does the robot of the second stand to that of the first?
//
//   points with normals -> { nearest point -> robust point-to-line step } -> Gaussian of the match
//
// Minimized over T = (x, y, phi), the pose of the robot in the frame of the robot at the reference
// scan, is
//
//   sum_i w_i (n_i^T (T q_i - p_i))^2 / s^2  +  |T - T_guess|^2 weighed by the guess's information
//
// with q_i the points of the scan, p_i and n_i foot and normal at the nearest point of the
// reference, s the spread of the residuals (from their median) and w_i Tukey's biweight. Pairs
// whose normals disagree do not count. Points are nearest by search along the bearing around the
// sensor of the reference, which ends where no farther beam can be nearer. Where few pairs fit, the
// search starts again from other headings.
//
// What comes out is what the points alone say: a Gaussian in information form, which may be
// singular, as along a corridor. Its information is sum w_i J_i^T J_i / (2 s^2): the points of the
// reference are as noisy as those of the scan, and every one enters several normals, so that their
// noise does not average out. Off go var(n_i) t_i^T t_i, t_i along the surface: what noise of the
// normals pretends to know there. A floor for what no noise explains comes on top as a covariance
// F: (I + L F)^-1 L for the information L.
//
// mrpt::slam::CICP pairs points with points, whose residuals along a wall hide that a corridor is
// blind in its direction.
//
// Source: Censi, "An ICP variant using a point-to-line metric", ICRA 2008 (search: sec. IV).

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/config/parameters.hpp>
#include <libslam/frontend/beam_points.hpp>
#include <libslam/frontend/scan_surface.hpp>

namespace mrpt::obs {
class CObservation2DRangeScan;
}

namespace libslam {

/// What the points say about T, relative to the guess, the floor included.
struct ScanMatch {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< L of (x [m], y [m], phi [rad])
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();         ///< L (T - T_guess)
  double fitting = 0.0;  ///< share of the points within 10 cm of the surface of the reference [1]
  double spread = 0.0;   ///< s [m]
  int iterations = 0;    ///< over all starts
};

/// Keeps its memory: from the second scan of a kind on nothing is allocated.
class ScanMatcher {
 public:
  explicit ScanMatcher(const ScanMatchingParameters& parameters);

  /// Takes in a level scan. False if it has too few points to be matched; there is no current scan
  /// then.
  bool look(const mrpt::obs::CObservation2DRangeScan& scan);
  /// The current scan becomes the reference.
  void renew_reference();
  bool has_reference() const { return !reference_.empty(); }

  /// Matches the current scan with the reference; nothing if fewer points than
  /// `min_overlap` fit. `guess`: T with its information.
  std::optional<ScanMatch> match(const Eigen::Vector3d& guess, const Eigen::Matrix3d& information);

 private:
  /// A point of the scan in the frame of the reference and the one that it was paired with.
  struct Pair {
    Eigen::Vector2d q, n, foot;
    double residual, var_turn;
  };
  /// Normal equations of the pairs at T, not yet divided by s^2.
  struct Sums {
    Eigen::Matrix3d hessian;
    Eigen::Vector3d gradient;
  };
  /// A minimum that was found.
  struct Minimum {
    Eigen::Vector3d T;
    Sums sums;
    double spread = 0.0, fitting = 0.0;
  };

  std::optional<Minimum> minimize(const Eigen::Vector3d& start, const Eigen::Vector3d& guess,
                                  const Eigen::Matrix3d& information);
  /// Fills pairs_; returns the share of the points that have a neighbour within `limit`.
  double pair(const Eigen::Vector3d& T, double limit);
  const SurfacePoint* nearest(const Eigen::Vector2d& q, double limit) const;
  /// 1.4826 times the median of the residuals, and at least the resolution of ranges.
  double spread_of_residuals();
  double share_that_fits(double paired) const;
  Sums add_up(const Eigen::Vector3d& T, double cut) const;
  ScanMatch gaussian(const Minimum& minimum, const Eigen::Vector3d& guess) const;

  ScanMatchingParameters parameters_;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero(), current_origin_ = Eigen::Vector2d::Zero();
  std::vector<BeamPoint> points_;
  std::vector<SurfacePoint> reference_, current_;
  std::vector<Pair> pairs_;
  std::vector<double> residuals_;
  int iterations_ = 0;
};

}  // namespace libslam
