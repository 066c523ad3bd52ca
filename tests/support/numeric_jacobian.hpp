#pragma once
// Numeric derivatives to hold analytic ones against: central differences in the chart of a block.
//
// Error of a central difference with step h: h^2/6 |f'''| + eps |f| / h. At h = cbrt(eps) = 6e-6
// both are about 4e-11 of |f'''| and |f|; for functions of order one to a hundred, 1e-8 is a safe
// bound.

#include <functional>

#include <Eigen/Core>

#include <libslam/state/gaussian_state.hpp>

namespace libslam::testing {

inline constexpr double kDifferenceStep = 6e-6;

/// d f / d x, `f` from vector to vector. `difference(a, b)` is a - b in the chart of the output.
inline Eigen::MatrixXd numeric_jacobian(
    const Eigen::VectorXd& x, const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f,
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&, const Eigen::VectorXd&)>&
        difference = [](const auto& a, const auto& b) -> Eigen::VectorXd { return a - b; }) {
  Eigen::MatrixXd jacobian;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const Eigen::VectorXd step = kDifferenceStep * Eigen::VectorXd::Unit(x.size(), j);
    const Eigen::VectorXd column = difference(f(x + step), f(x - step)) / (2.0 * kDifferenceStep);
    if (j == 0) jacobian.resize(column.size(), x.size());
    jacobian.col(j) = column;
  }
  return jacobian;
}

/// d f / d block: the estimate of `block` is moved by boxplus, `f` sees the moved state, and
/// `difference(a, b)` is a - b in the chart of the output of `f`.
inline Eigen::MatrixXd numeric_jacobian(
    const GaussianState& state, BlockId block,
    const std::function<Eigen::VectorXd(const GaussianState&)>& f,
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&, const Eigen::VectorXd&)>&
        difference) {
  const auto moved = [&](const Eigen::VectorXd& delta) {
    GaussianState copy = state;
    Eigen::VectorXd estimate = state.estimate(block);
    boxplus(state.spec(block), estimate, delta);
    copy.set_estimate(block, estimate);
    return f(copy);
  };
  return numeric_jacobian(Eigen::VectorXd::Zero(state.size(block)), moved, difference);
}

/// The same where the output is a block of the state with the given spec.
inline Eigen::MatrixXd numeric_jacobian(
    const GaussianState& state, BlockId block,
    const std::function<Eigen::VectorXd(const GaussianState&)>& f, const BlockSpec& output) {
  return numeric_jacobian(state, block, f, [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return Eigen::VectorXd(boxminus(output, a, b));
  });
}

}  // namespace libslam::testing
