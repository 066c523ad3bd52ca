#include <stdexcept>
#include <string>

#include <Eigen/Cholesky>

#include <libslam/policy/excitation.hpp>

namespace libslam {

Excitation::Excitation(std::vector<double> nominal)
    : nominal_(std::move(nominal)),
      jacobian_(Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(nominal_.size()))),
      mean_snr_(Eigen::VectorXd::Zero(jacobian_.cols())),
      excited_(nominal_.size(), false),
      ever_excited_(nominal_.size(), false) {}

void Excitation::observe(const Eigen::Ref<const Eigen::Matrix3Xd>& jacobian,
                         const Eigen::Matrix3d& noise, double dt) {
  jacobian_ += jacobian;
  noise_ += noise;
  elapsed_ += dt > 0.0 ? dt : kWindow;
  if (elapsed_ >= kWindow) close_window();
}

std::vector<double> Excitation::memory() const {
  std::vector<double> memory(noise_.data(), noise_.data() + noise_.size());
  memory.push_back(elapsed_);
  memory.insert(memory.end(), jacobian_.data(), jacobian_.data() + jacobian_.size());
  memory.insert(memory.end(), mean_snr_.data(), mean_snr_.data() + mean_snr_.size());
  for (const bool flag : excited_) memory.push_back(flag ? 1.0 : 0.0);
  for (const bool flag : ever_excited_) memory.push_back(flag ? 1.0 : 0.0);
  return memory;
}

void Excitation::remember(std::span<const double> memory) {
  constexpr std::size_t kShared = 10, kEach = 6;  // noise and elapsed time; the rest per parameter
  if (memory.size() != kShared + kEach * nominal_.size())
    throw std::invalid_argument("the memory of an excitation has " + std::to_string(memory.size()) +
                                " numbers for " + std::to_string(nominal_.size()) + " parameters");
  auto number = memory.begin();
  for (double& value : noise_.reshaped()) value = *number++;
  elapsed_ = *number++;
  for (double& value : jacobian_.reshaped()) value = *number++;
  for (double& value : mean_snr_) value = *number++;
  for (auto&& flag : excited_) flag = *number++ != 0.0;
  for (auto&& flag : ever_excited_) flag = *number++ != 0.0;
}

void Excitation::close_window() {
  // A noise-free direction is known exactly: the floor only keeps the factorization defined.
  const double floor = 1e-12 + 1e-9 * noise_.trace();
  const Eigen::LLT<Eigen::Matrix3d> factor(noise_ + floor * Eigen::Matrix3d::Identity());
  for (Eigen::Index i = 0; i < jacobian_.cols(); ++i) {
    const Eigen::Vector3d scaled = nominal_[static_cast<std::size_t>(i)] * jacobian_.col(i);
    const double snr = factor.matrixL().solve(scaled).squaredNorm();
    mean_snr_[i] = kForgetting * mean_snr_[i] + (1.0 - kForgetting) * snr;
    const auto parameter = static_cast<std::size_t>(i);
    excited_[parameter] = mean_snr_[i] > kThreshold;
    ever_excited_[parameter] = ever_excited_[parameter] || excited_[parameter];
  }
  jacobian_.setZero();
  noise_.setZero();
  elapsed_ = 0.0;
}

}  // namespace libslam
