#pragma once
// What a correction leaves behind of its measurements.

#include <cstddef>

#include <libslam/data/feature.hpp>

namespace libslam {

/// One measurement of a correction, seen from both sides of it.
struct Postfit {
  std::size_t feature = 0;           ///< position in the features of the observation
  MeasurementVector innovation;      ///< nu = z - h(x-)
  MeasurementMatrix cov_innovation;  ///< S = H P- H^T + R, its own rows and columns
  MeasurementVector residual;        ///< e = R S^-1 nu, rows of its own in the joint S
  MeasurementMatrix cov_predicted;   ///< C = H P+ H^T = R - R S^-1 R, its own rows and columns
};

}  // namespace libslam
