#pragma once
// What a correction knows of its measurements once it has factored S = H P- H^T + R.

#include <cstddef>

#include <libslam/data/feature.hpp>

namespace libslam {

/// One measurement of a correction, seen from both sides of it. With the joint S, after the
/// correction its residual is e = R (S^-1 nu) and the covariance of its prediction
/// H P+ H^T = R - R S^-1 R, each by the rows and columns of the measurement. Exact where every
/// block was corrected.
struct Postfit {
  std::size_t feature = 0;           ///< position in the features of the observation
  MeasurementVector innovation;      ///< nu = z - h(x-)
  MeasurementMatrix cov_innovation;  ///< S, its own rows and columns
  MeasurementVector weighted;        ///< S^-1 nu, its own rows
  MeasurementMatrix information;     ///< S^-1, its own rows and columns
};

}  // namespace libslam
