#pragma once
// Chi-square thresholds for gates and consistency bands.

namespace libslam {

/// x with P(chi-square with `dof` degrees of freedom <= x) = `probability`; infinity at 1.
/// Throws std::invalid_argument outside 0 <= probability <= 1 or dof < 1.
double chi_square_quantile(double probability, int dof);

/// P(chi-square with `dof` degrees of freedom <= x).
double chi_square_probability(double x, int dof);

}  // namespace libslam
