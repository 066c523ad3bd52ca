#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <libslam/policy/process_scale.hpp>

namespace libslam {

ProcessScale::ProcessScale(const ProcessAdaptationParameters& parameters, double kappa)
    : parameters_(parameters),
      kappa_(kappa),
      past_(std::pow(parameters.forgetting, parameters.prior_weight)) {
  if (!(parameters.forgetting > 0.0 && parameters.forgetting < 1.0))
    throw std::invalid_argument("process adaptation: forgetting must be in (0, 1), got " +
                                std::to_string(parameters.forgetting));
  if (!(parameters.prior_weight >= 1.0))
    throw std::invalid_argument("process adaptation: prior_weight must be >= 1, got " +
                                std::to_string(parameters.prior_weight));
  if (!(parameters.min_factor > 0.0 && parameters.min_factor < parameters.max_factor))
    throw std::invalid_argument("process adaptation: min_factor must be below max_factor");
  if (!(kappa > 0.0 && kappa <= 1.0))
    throw std::invalid_argument("process adaptation: kappa " + std::to_string(kappa));
}

void ProcessScale::scale(const BlockMatrix& F, BlockMatrix& cov_noise) {
  if (taken_up_.size() == 0) {
    taken_up_ = cov_noise;
  } else {
    const BlockMatrix moved = F * taken_up_;
    taken_up_ = cov_noise;
    taken_up_.noalias() += moved * F.transpose();
  }
  cov_noise *= factor_;
}

void ProcessScale::observe(const BlockEvidence& of_pose) {
  if (taken_up_.size() == 0) return;  // the robot has not moved since the last correction
  const double d = (1.0 - parameters_.forgetting) / (1.0 - past_);
  past_ *= parameters_.forgetting;
  const double squares = of_pose.score.dot(taken_up_ * of_pose.score) / kappa_;
  const double expected = of_pose.information.cwiseProduct(taken_up_).sum();
  const auto n = static_cast<double>(taken_up_.rows());
  factor_ = std::clamp(factor_ + d * factor_ * factor_ / n * (squares - expected),
                       parameters_.min_factor, parameters_.max_factor);
  taken_up_.resize(0, 0);
}

AdaptedNoise ProcessScale::noise() const {
  return {"odometry", std::sqrt(factor_), 1.0};
}

}  // namespace libslam
