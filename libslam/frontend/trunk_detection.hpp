#pragma once
// Trunks and other upright cylinders in one scan of a planar laser.

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/config/parameters/trunks.hpp>

namespace libslam {

/// A circle, in the frame of the laser.
struct DetectedTrunk {
  double range = 0.0;     ///< to the centre [m]
  double bearing = 0.0;   ///< of the centre [rad], left positive
  double diameter = 0.0;  ///< [m]
  std::size_t first_beam = 0, beams = 0;
  Eigen::Matrix2d cov = Eigen::Matrix2d::Zero();  ///< of (range, bearing)
};

/// Ranges [m] of beams that look along first_bearing + i * resolution [rad]; infinite where nothing
/// came back. A beam without return sees past every object.
struct BeamView {
  std::span<const double> ranges;
  double first_bearing = 0.0, resolution = 0.0;
};

/// Objects are runs of beams whose ranges do not jump; beams without return interrupt them only
/// where they fill more than gap_deg. One is a trunk if
/// - it stands free: next to both of its edges the laser sees farther, so that no nearer object
///   hides a part of it, it is not at the end of the scan, and the objects before and after it are
///   farther from it than `isolation`;
/// - it has enough beams, a diameter within bounds, and edges at about equal range (`skew`).
///
/// A circle of radius rho at distance D fills the angle w = 2 asin(rho / D), in which n = w /
/// resolution beams are to be expected (those without return between its edges count). Its centre
/// is in the middle of the edges, at theta, and each of its beams (r, beta) says how far:
///   D = r cos(beta - theta) + sqrt(rho^2 - r^2 sin^2(beta - theta)),   rho = D sin(w / 2),
/// of which the mean is taken, weighted by the squared cosine of the incidence. Where the edges
/// fall between the beams is uniform, hence var(theta) = resolution^2 / 24 and var(rho) = D^2
/// resolution^2 / 24; to these come the noise of the ranges and sigma_centre along and across.
///
/// The rules (segments by jump, edges in front of what is beside them, diameter from the angle) are
/// those of Guivant, Nebot and Durrant-Whyte, "Localization and map building using laser range
/// sensors in outdoor applications", J. Robotic Systems 17(10), 2000, sec. 4.
class TrunkDetector {
 public:
  /// Throws std::invalid_argument where a bound is negative or no diameter lies between the bounds.
  explicit TrunkDetector(const TrunkParameters& parameters);
  /// Overwrites `trunks`, in the order of the beams.
  void detect(const BeamView& scan, std::vector<DetectedTrunk>& trunks);

 private:
  /// Beams from `first` to `last`.
  struct Object {
    std::size_t first, last;
  };
  void segment(const BeamView& scan);
  bool stands_free(const BeamView& scan, const Object& object) const;
  bool is_isolated(const BeamView& scan, std::size_t index) const;
  DetectedTrunk fit(const BeamView& scan, const Object& object) const;
  bool has_shape(const BeamView& scan, const DetectedTrunk& trunk) const;

  std::vector<Object> objects_;  // of the last scan
  TrunkParameters parameters_;
};

}  // namespace libslam
