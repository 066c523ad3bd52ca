#pragma once
// Most walls of a building are parallel or at right angles.
//
//   0 = wrap_90(alpha - psi) + v,   v ~ N(0, sigma^2)
//
// with alpha the direction of the normal of a line, psi the main direction of the building (a block
// of the state, Chart::kAngle), and wrap_90 the difference to the nearest multiple of a right
// angle.

#include <libslam/state/gaussian_state.hpp>
#include <libslam/state/linearization.hpp>

namespace libslam {

class DirectionPrior {
 public:
  /// `sigma`: how far walls stray from the main direction [rad]. Throws std::invalid_argument
  /// unless it is positive.
  explicit DirectionPrior(double sigma);

  /// The block of the main direction. A turn of the world turns it by the same angle; the additive
  /// error of an angle is what both error frames keep then.
  static BlockSpec direction_spec();
  /// `line`: a block of Chart::kLine.
  void linearize(const GaussianState& state, BlockId direction, BlockId line,
                 LinearizedMeasurement& out) const;

 private:
  double variance_;
};

}  // namespace libslam
