#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <libslam/measurement/direction_prior.hpp>

namespace libslam {

DirectionPrior::DirectionPrior(double sigma) : variance_(sigma * sigma) {
  if (!(sigma > 0.0))
    throw std::invalid_argument("the spread of walls must be positive, is " +
                                std::to_string(sigma));
}

BlockSpec DirectionPrior::direction_spec() {
  return {"wall_direction", Chart::kAngle, 1, WorldRole::kNone};
}

void DirectionPrior::linearize(const GaussianState& state, BlockId direction, BlockId line,
                               LinearizedMeasurement& out) const {
  const double apart = state.estimate(line)[0] - state.estimate(direction)[0];
  out.innovation = MeasurementVector::Constant(1, -std::remainder(apart, 0.5 * std::numbers::pi));
  out.cov = MeasurementMatrix::Constant(1, 1, variance_);
  out.wrt.clear();
  out.wrt.add(direction, 1, 1)(0, 0) = -1.0;
  out.wrt.add(line, 1, 2)(0, 0) = 1.0;
}

}  // namespace libslam
