#pragma once
// Noise estimators fed with problems whose answer is known.

#include <span>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include <libslam/policy/sage_husa.hpp>

namespace libslam::test {

inline NoiseAdaptationParameters residual_form() {
  NoiseAdaptationParameters parameters;
  parameters.method = "residual";
  parameters.forgetting = 0.98;
  return parameters;
}

inline std::vector<NoiseComponent> components(int dimension, double floor = 1e-6,
                                              double ceiling = 1e6) {
  std::vector<NoiseComponent> all;
  for (int i = 0; i < dimension; ++i)
    all.push_back({std::string(1, static_cast<char>('a' + i)), 1.0, floor, ceiling, 0.0});
  return all;
}

inline Feature feature_with(const Eigen::MatrixXd& cov, std::int64_t id = 1) {
  Feature feature;
  feature.id = id;
  feature.z = Eigen::VectorXd::Ones(cov.rows());
  feature.cov = cov;
  return feature;
}

/// A measurement alone, given H P- H^T.
inline Postfit postfit_of(const Eigen::MatrixXd& predicted, const Eigen::MatrixXd& r,
                          const Eigen::VectorXd& nu, std::size_t feature = 0) {
  const Eigen::MatrixXd s = predicted + r;
  Postfit postfit;
  postfit.feature = feature;
  postfit.innovation = nu;
  postfit.cov_innovation = s;
  postfit.weighted = s.ldlt().solve(nu);
  postfit.information = s.inverse();
  return postfit;
}

/// Features of an observation, each measuring something of its own known up to `predicted`, as a
/// filter would have the policy learn from them: again as often as it asks for. Returns how often.
inline int learn(SageHusa& policy, std::vector<Feature>& features, const Eigen::MatrixXd& predicted,
                 const std::vector<Eigen::VectorXd>& nu) {
  std::vector<Postfit> postfits;
  for (int rounds = 1;; ++rounds) {
    postfits.clear();
    for (std::size_t i = 0; i < features.size(); ++i)
      postfits.push_back(postfit_of(predicted, features[i].cov, nu[i], i));
    if (!policy.observe(features, postfits)) return rounds;
  }
}

}  // namespace libslam::test
