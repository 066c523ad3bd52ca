#pragma once
// Chi-square thresholds for gates and consistency bands.

namespace libslam {

/// x with P(chi-square with `dof` degrees of freedom <= x) = `probability`; infinity at 1.
/// Throws std::invalid_argument outside 0 <= probability <= 1 or dof < 1.
double chi_square_quantile(double probability, int dof);

/// P(chi-square with `dof` degrees of freedom <= x).
double chi_square_probability(double x, int dof);

/// A normal vector that passes a chi-square gate at `probability` has this much of the covariance
/// that it has without gate: F_{dof+2}(x) / F_dof(x) at the gate x, in (0, 1]. Throws like
/// chi_square_quantile, and at probability 0. Source: Tallis, J. Royal Stat. Soc. B 25 (1963) 223.
double gated_covariance(double probability, int dof);

}  // namespace libslam
