#pragma once
// Random matrices for tests, from an explicit generator.

#include <random>

#include <Eigen/Core>

namespace libslam::testing {

inline Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index cols, std::mt19937_64& random,
                                     double sigma = 1.0) {
  std::normal_distribution<double> normal(0.0, sigma);
  Eigen::MatrixXd m(rows, cols);
  for (Eigen::Index c = 0; c < cols; ++c)
    for (Eigen::Index r = 0; r < rows; ++r) m(r, c) = normal(random);
  return m;
}

/// Symmetric positive definite with eigenvalues of order sigma^2.
inline Eigen::MatrixXd random_covariance(Eigen::Index n, std::mt19937_64& random,
                                         double sigma = 1.0) {
  const Eigen::MatrixXd a = random_matrix(n, n, random, sigma);
  return a * a.transpose() / static_cast<double>(n) +
         0.1 * sigma * sigma * Eigen::MatrixXd::Identity(n, n);
}

}  // namespace libslam::testing
