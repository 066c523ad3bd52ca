#include <boost/math/distributions/chi_squared.hpp>
#include <limits>
#include <stdexcept>
#include <string>

#include <libslam/state/chi_square.hpp>

namespace libslam {

double chi_square_quantile(double probability, int dof) {
  if (!(probability >= 0.0 && probability <= 1.0))
    throw std::invalid_argument("chi-square probability must be in [0, 1], got " +
                                std::to_string(probability));
  if (dof < 1)
    throw std::invalid_argument("chi-square dof must be >= 1, got " + std::to_string(dof));
  if (probability == 1.0) return std::numeric_limits<double>::infinity();
  return boost::math::quantile(boost::math::chi_squared(dof), probability);
}

double chi_square_probability(double x, int dof) {
  if (dof < 1)
    throw std::invalid_argument("chi-square dof must be >= 1, got " + std::to_string(dof));
  return x > 0.0 ? boost::math::cdf(boost::math::chi_squared(dof), x) : 0.0;
}

double gated_covariance(double probability, int dof) {
  const double gate = chi_square_quantile(probability, dof);
  if (probability <= 0.0) throw std::invalid_argument("a gate of probability 0 lets nothing pass");
  return std::isinf(gate) ? 1.0 : chi_square_probability(gate, dof + 2) / probability;
}

}  // namespace libslam
