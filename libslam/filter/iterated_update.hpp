#pragma once
// The iterated EKF: a correction whose measurements are linearized where it leads to, not where it
// starts. For a state so uncertain that the bend of the measurement model shows within its
// uncertainty: a velocity of which nothing is known, a point of which only the direction is.
//
//   delta_k+1 = K_k (nu_k + H_k delta_k),   nu_k = z - h(x_k),  x_k = x [+] delta_k,  delta_0 = 0
//
// with K_k, H_k taken at x_k: Gauss-Newton on the posterior. Source: Bell & Cathey, The iterated
// Kalman filter update as a Gauss-Newton method, IEEE TAC 38(2), 1993, equation 8.
//
// Models differentiate by the additive error of x_k; H_k above differentiates by that of x, where
// the covariance is. The change of chart T(x_k) T(x)^-1 of the error frame stands between the two.
// It takes [+] as linear in the turn within a step: derivatives are wrong by half of that turn,
// relatively, the residual nu_k is exact.

#include <functional>
#include <span>
#include <vector>

#include <libslam/filter/ekf.hpp>

namespace libslam {

class IteratedUpdate {
 public:
  /// Linearizes the measurement with this position at the present estimates, of the same length and
  /// with respect to the same blocks as before; an innovation that is not finite: it cannot be seen
  /// from here.
  using Relinearize = std::function<void(std::size_t, LinearizedMeasurement&)>;

  /// At most `linearizations` of one correction. Throws std::invalid_argument below 1.
  explicit IteratedUpdate(int linearizations);

  /// Ekf::correct, repeated until the measurements are where their linearization said, but for a
  /// tenth of a sigma (root mean square). `measurements` come linearized at the estimate and are
  /// left as they were used. Where one cannot be seen after a step, that step is the correction.
  Correction correct(GaussianState& state, Ekf& ekf, BlockId pose,
                     std::span<LinearizedMeasurement> measurements,
                     std::span<const BlockId> considered, const Relinearize& relinearize);

 private:
  /// Fills again_ at the end of the step that `ekf` solved; false where that is not possible.
  bool linearize_there(GaussianState& state, const Ekf& ekf, BlockId pose,
                       std::span<const LinearizedMeasurement> measurements,
                       const Relinearize& relinearize);
  /// The step leads where `measurements` said.
  bool agrees(std::span<const LinearizedMeasurement> measurements) const;

  int linearizations_;
  std::vector<LinearizedMeasurement> again_;
  std::vector<BlockVector> kept_;  // the estimates meanwhile
};

}  // namespace libslam
