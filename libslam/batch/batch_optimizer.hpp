#pragma once
// The best possible answer on the data of a run: nonlinear least squares (Ceres) over all poses,
// all landmarks and the calibration, with the models, noise, priors and associations of the filter.
//
//   min  |prior of start and calibration|^2 + sum |x_k+1 - f(x_k, c)|^2_Q + sum |z - h(x, l)|^2_R
//
// Gates and robustness are the filter's verdicts; nothing is reweighted by its residual. A
// parameter with a random walk has one value per pose. There is one pose per update: motions
// between two updates are joined (motion_chain.hpp), which is what the filter does with them, and
// the poses in between follow by smoothing. Q is taken at the estimate and renewed until the answer
// stays.

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <libslam/batch/batch_log.hpp>
#include <libslam/filter/ekf_slam.hpp>

namespace libslam {

struct BatchOptions {
  int max_iterations = 200;       ///< of the solver, per set of weights
  bool calibration_sigma = true;  ///< costs a sparse QR of the whole problem
};

struct BatchResult {
  BatchEstimate estimate;
  /// Standard deviations, as estimate.calibration; empty if not asked for or the problem is
  /// singular.
  Eigen::VectorXd sigma_calibration;
  double chi_square_before = 0.0;  ///< sum of squared whitened residuals at the start values
  double chi_square = 0.0;         ///< the same at the estimate
  int degrees_of_freedom = 0;      ///< residuals - unknowns
  int poses = 0;                   ///< unknown poses
  int iterations = 0;
  bool converged = false;
};

/// Optimizes from `start`. Of `parts` the models, the start pose's covariance (zero: it is fixed)
/// and the covariance of steps without odometry are used. Throws std::invalid_argument where
/// `start` does not fit `log` or `parts`, std::runtime_error where the solver fails or `start` is
/// not finite.
BatchResult optimize_batch(const BatchLog& log, const EkfSlamParts& parts,
                           const BatchEstimate& start, const BatchOptions& options = {});

/// What the batch would have said on line: for each of `steps` (positions in log.steps) the last
/// pose of the optimum over the log up to that step. A filter knows as much at that time, so this
/// is what its path can be held against. Throws like optimize_batch, std::invalid_argument on a
/// position beyond the log.
std::vector<Eigen::Vector3d> optimize_on_line(const BatchLog& log, const EkfSlamParts& parts,
                                              const BatchEstimate& start,
                                              std::span<const std::size_t> steps);

}  // namespace libslam
