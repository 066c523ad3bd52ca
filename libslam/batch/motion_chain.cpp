#include <algorithm>

#include <Eigen/Eigenvalues>

#include <libslam/batch/motion_chain.hpp>

namespace libslam {

namespace {

constexpr double kRelativeFloor = 1e-3, kAbsoluteFloor = 1e-5;

}  // namespace

MotionChain::MotionChain(const MotionModel& model, const Eigen::Matrix3d& cov_no_odometry)
    : model_(model), cov_no_odometry_(cov_no_odometry) {
  pose_ = state_.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, Eigen::Vector3d::Zero(),
                     Eigen::Matrix3d::Zero());
  for (const CalibrationSpec& parameter : model.calibration())
    calibration_.push_back(state_.add({parameter.name, Chart::kVector, 1, WorldRole::kNone},
                                      Eigen::VectorXd::Constant(1, parameter.prior_mean),
                                      Eigen::MatrixXd::Zero(1, 1)));
  start(Eigen::Vector3d::Zero(),
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(calibration_.size())));
}

void MotionChain::start(const Eigen::Vector3d& pose, const Eigen::VectorXd& calibration) {
  for (std::size_t i = 0; i < calibration_.size(); ++i)
    state_.set_estimate(calibration_[i], calibration.segment<1>(static_cast<Eigen::Index>(i)));
  end_ = pose;
  phi_.setIdentity();
  transition_.setIdentity();
  cov_.setZero();
  gamma_.setZero(3, static_cast<Eigen::Index>(calibration_.size()));
}

void MotionChain::append(const std::optional<MotionAction>& motion) {
  if (!motion) {
    transition_.setIdentity();
    cov_ += cov_no_odometry_;
    return;
  }
  state_.set_estimate(pose_, end_);
  model_.linearize(state_, pose_, calibration_, *motion, step_);
  own_gamma_.setZero(3, gamma_.cols());
  for (const auto& [block, jacobian] : step_.wrt) {
    if (block == pose_) transition_ = jacobian;
    for (std::size_t i = 0; i < calibration_.size(); ++i)
      if (block == calibration_[i]) own_gamma_.col(static_cast<Eigen::Index>(i)) = jacobian;
  }
  end_ = step_.estimate;
  phi_ = transition_ * phi_;
  gamma_ = transition_ * gamma_ + own_gamma_;
  cov_ = transition_ * cov_ * transition_.transpose() + step_.cov_noise;
}

Eigen::Matrix3d whitening_of(const Eigen::Matrix3d& cov) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(cov);
  const double largest = eigen.eigenvalues().maxCoeff();
  const double floor =
      std::max(kAbsoluteFloor * kAbsoluteFloor, kRelativeFloor * kRelativeFloor * largest);
  return eigen.eigenvalues().cwiseMax(floor).cwiseSqrt().cwiseInverse().asDiagonal() *
         eigen.eigenvectors().transpose();
}

std::vector<Eigen::Vector3d> interpolate(MotionChain& chain, const Eigen::Vector3d& from,
                                         const Eigen::Vector3d& to,
                                         const Eigen::VectorXd& calibration,
                                         MotionChain::Motions motions) {
  struct Node {
    Eigen::Vector3d pose;
    Eigen::Matrix3d cov, transition;
  };
  std::vector<Node> nodes;
  nodes.reserve(motions.size());
  chain.start(from, calibration);
  for (const auto& motion : motions) {
    chain.append(motion);
    nodes.push_back({chain.end(), chain.covariance(), chain.last_transition()});
  }
  std::vector<Eigen::Vector3d> poses(nodes.empty() ? 0 : nodes.size() - 1);
  if (poses.empty()) return poses;
  Eigen::Vector3d deviation = to - chain.end();
  deviation[2] = wrap_angle(deviation[2]);
  const Eigen::Matrix3d whitening = whitening_of(chain.covariance());
  Eigen::Vector3d pull = whitening.transpose() * (whitening * deviation);
  for (std::size_t k = poses.size(); k-- > 0;) {
    pull = nodes[k + 1].transition.transpose() * pull;
    poses[k] = nodes[k].pose + nodes[k].cov * pull;
    poses[k][2] = wrap_angle(poses[k][2]);
  }
  return poses;
}

}  // namespace libslam
