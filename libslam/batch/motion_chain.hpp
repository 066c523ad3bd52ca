#pragma once
// Motions one after another as a single one: x' = f(x, c) + w.
//
// With F_k, G_k, Q_k the linearization of motion k (motion_model.hpp) at the noiseless path,
//
//   Phi <- F_k Phi,   Gamma <- F_k Gamma + G_k,   C <- F_k C F_k^T + Q_k
//
// which is what a filter does between two updates: exact but for noise of second order.

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/motion/motion_model.hpp>

namespace libslam {

class MotionChain {
 public:
  using Motions = std::span<const std::optional<MotionAction>>;

  /// `cov_no_odometry`: what a motion without odometry adds. `model` must outlive the chain.
  MotionChain(const MotionModel& model, const Eigen::Matrix3d& cov_no_odometry);

  /// Starts at `pose` with one calibration value per parameter of the model.
  void start(const Eigen::Vector3d& pose, const Eigen::VectorXd& calibration);
  void append(const std::optional<MotionAction>& motion);

  const Eigen::Vector3d& end() const { return end_; }
  const Eigen::Matrix3d& wrt_pose() const { return phi_; }                ///< Phi
  const Eigen::Matrix3Xd& wrt_calibration() const { return gamma_; }      ///< Gamma
  const Eigen::Matrix3d& covariance() const { return cov_; }              ///< C, world frame
  const Eigen::Matrix3d& last_transition() const { return transition_; }  ///< F of the last motion

 private:
  const MotionModel& model_;
  Eigen::Matrix3d cov_no_odometry_;
  GaussianState state_;  // the blocks that the model reads; its covariance plays no part
  BlockId pose_;
  CalibrationBlocks calibration_;
  MotionStep step_;
  Eigen::Vector3d end_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d phi_, cov_, transition_;
  Eigen::Matrix3Xd gamma_, own_gamma_;
};

/// W with W C W^T = I for a covariance of (x [m], y [m], phi [rad]) that may be singular, as that
/// of a drive without sideways noise: deviations along a direction of no noise are held to 1e-3 of
/// the largest standard deviation and to 1e-5 (m, rad), whichever is larger. Legitimate ratios are
/// above 1e-3 on stretches below a kilometre: the heading given the end of a stretch of length L is
/// known to about 1 / L [rad/m] of the deviation of that end.
Eigen::Matrix3d whitening_of(const Eigen::Matrix3d& cov);

/// Most likely poses after each of `motions` but the last, given the poses at both ends: the
/// chain's own poses plus C_k Phi_(k to n)^T C_n^-1 (to - f(from)), the fixed-interval smoother.
std::vector<Eigen::Vector3d> interpolate(MotionChain& chain, const Eigen::Vector3d& from,
                                         const Eigen::Vector3d& to,
                                         const Eigen::VectorXd& calibration,
                                         MotionChain::Motions motions);

}  // namespace libslam
