#pragma once
// One factor on the process noise Q, estimated on line.
//
//   between two corrections the pose takes up   w ~ N(0, s Q0),  Q0 <- F Q0 F^T + Q
//   a correction says of it (state coordinates of the pose, H its columns)
//     w_hat = s Q0 g,  Cov w = s Q0 - s^2 Q0 M Q0,   g = H^T S^-1 nu,  M = H^T S^-1 H
//   s <- (1 - d) s + (d / n) tr Q0^-1 (w_hat w_hat^T + Cov w)
//      = s + d s^2 / n (g^T Q0 g / kappa - tr M Q0),   n the dimension of the pose
//
// A step of expectation maximization like the residual form of R (policy/sage_husa.hpp): s stays
// positive because s M <= Q0^-1, whatever comes. Q0 is never inverted, so that it may be singular.
// The shape of Q is the motion model's; a full pose covariance would have to be learned from
// increments that turn with the robot, through landmarks that see some directions only. The mean q
// of the noise is a matter of calibration, which has it as blocks of the state.
//
// kappa: state/chi_square.hpp, gated_covariance. Source: Sage & Husa 1969, seeds.md (S3.14), in
// this form from the E step of Shumway & Stoffer, J. Time Series Analysis 3 (1982) 253.

#include <libslam/config/parameters/noise_adaptation.hpp>
#include <libslam/data/step_record.hpp>
#include <libslam/state/block_evidence.hpp>

namespace libslam {

class ProcessScale {
 public:
  /// `kappa`: in (0, 1]. Throws std::invalid_argument on a parameter out of its range.
  ProcessScale(const ProcessAdaptationParameters& parameters, double kappa);

  /// A step of motion is about to be made: scales its noise, and adds it to what will be learned
  /// from. `F`: derivative of the new pose with respect to the old one.
  void scale(const BlockMatrix& F, BlockMatrix& cov_noise);
  void observe(const BlockEvidence& of_pose);
  /// In place of `observe`: nothing is learned from the motion since the last correction.
  void skip() { taken_up_.resize(0, 0); }
  /// s.
  double factor() const { return factor_; }
  /// Its root, as "odometry" against 1.
  AdaptedNoise noise() const;

 private:
  ProcessAdaptationParameters parameters_;
  double kappa_, past_, factor_ = 1.0;
  BlockMatrix taken_up_;  ///< Q0
};

}  // namespace libslam
