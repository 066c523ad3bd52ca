#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Cholesky>

#include <libslam/policy/implied_input.hpp>
#include <libslam/state/chi_square.hpp>

namespace libslam {

ImpliedInput::ImpliedInput(double probability) : probability_(probability) {
  if (!(probability > 0.0 && probability < 1.0))
    throw std::invalid_argument("probability of an implied motion must be in (0, 1), got " +
                                std::to_string(probability));
}

void ImpliedInput::move(const BlockMatrix& transition, const BlockMatrix& cov_noise) {
  if (cov_.size() == 0) {
    cov_ = cov_noise;
    return;
  }
  const BlockMatrix carried = transition * cov_ * transition.transpose();
  cov_ = carried + cov_noise;
}

double ImpliedInput::squared_motion(const JointInnovation& joint) const {
  if (cov_.size() == 0) return 0.0;
  const Eigen::LLT<Eigen::MatrixXd> factor(joint.cov);
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  const TangentVector g = joint.wrt_pose.transpose() * factor.solve(joint.nu);
  return g.dot(cov_ * g);
}

bool ImpliedInput::impossible(const JointInnovation& joint) const {
  if (cov_.size() == 0) return false;
  return squared_motion(joint) > chi_square_quantile(probability_, static_cast<int>(cov_.rows()));
}

void ImpliedInput::restart() {
  cov_.resize(0, 0);
}

}  // namespace libslam
