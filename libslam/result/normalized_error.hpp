#pragma once
// The squared error of a pose in units of its covariance.

#include <limits>

#include <Eigen/Dense>

#include <libslam/state/chi_square.hpp>

namespace libslam {

/// Smallest eigenvalue of a correlation matrix that is more than the rounding of its entries, with
/// a margin: the first motion from a known pose has a covariance of deficient rank.
inline constexpr double kSingularCorrelation = 1e-12;

/// e^T cov^-1 e; NaN where the covariance is singular up to rounding.
template <int N>
double normalized_square(const Eigen::Matrix<double, N, 1>& e,
                         const Eigen::Matrix<double, N, N>& cov) {
  // Scaled by its standard deviations, so that a direction without variance shows in any unit.
  const Eigen::Matrix<double, N, 1> scale = cov.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> spectrum(
      scale.asDiagonal() * cov * scale.asDiagonal());
  const Eigen::Matrix<double, N, 1> along =
      spectrum.eigenvectors().transpose() * scale.cwiseProduct(e);
  return spectrum.eigenvalues()[0] > kSingularCorrelation
             ? along.cwiseAbs2().cwiseQuotient(spectrum.eigenvalues()).sum()
             : std::numeric_limits<double>::quiet_NaN();
}

/// What half of the values of a consistent filter with `dof` degrees of freedom stay below.
inline double median_normalized_square(int dof) {
  return chi_square_quantile(0.5, dof);
}

}  // namespace libslam
