#pragma once
// Whitened residuals of a least-squares problem over poses, landmarks and calibration, with their
// derivatives. Every model is asked through its own `linearize`: there is no second copy of any.
//
// Parameters are additive: poses (x, y, phi), landmarks and calibration values. Jacobians are
// row-major, one per parameter, as solvers take them; null: not wanted.

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <libslam/batch/motion_chain.hpp>
#include <libslam/measurement/measurement_model.hpp>

namespace libslam {

/// What a residual looks like to a solver.
class Residual {
 public:
  virtual ~Residual() = default;
  virtual int rows() const = 0;
  virtual std::vector<int> parameter_sizes() const = 0;
  virtual void evaluate(const double* const* parameters, double* residual,
                        double** jacobians) const = 0;
};

/// Parameters: pose before, pose after, each calibration value.
///
///   r = W R(phi)^T (x' - f(x, c)),   W C_body W^T = I,   C_body = R(phi)^T C R(phi)
///
/// In the frame of the robot the noise does not depend on where it stands, so W is a constant
/// between two calls of `reweight` and the derivatives are exact.
class MotionResidual final : public Residual {
 public:
  /// `chain` is a workspace that residuals of one thread share; it and `motions` must outlive this.
  MotionResidual(std::shared_ptr<MotionChain> chain,
                 std::vector<std::optional<MotionAction>> motions);

  const std::vector<std::optional<MotionAction>>& motions() const { return motions_; }
  /// Takes the noise at this pose and calibration.
  void reweight(const Eigen::Vector3d& pose, const Eigen::VectorXd& calibration);

  int rows() const override { return 3; }
  std::vector<int> parameter_sizes() const override;
  void evaluate(const double* const* parameters, double* residual,
                double** jacobians) const override;

 private:
  void run_chain(const Eigen::Vector3d& pose, const Eigen::VectorXd& calibration) const;

  std::shared_ptr<MotionChain> chain_;
  std::vector<std::optional<MotionAction>> motions_;
  Eigen::Matrix3d whitening_ = Eigen::Matrix3d::Identity();
};

/// The blocks that a measurement model reads, shared by the sightings of one thread.
struct SightingWorkspace {
  /// Throws std::invalid_argument for a landmark whose estimate is not additive (SE(3)).
  explicit SightingWorkspace(const MeasurementModel& sensor);

  const MeasurementModel& model;
  GaussianState state;
  BlockId pose, landmark;
  LinearizedMeasurement linearized;
};

/// Parameters: pose, landmark. r = L^-1 (z - h(x, l)) with the noise R = L L^T of the feature.
class SightingResidual final : public Residual {
 public:
  /// `feature` must outlive this.
  SightingResidual(std::shared_ptr<SightingWorkspace> workspace, const Feature& feature);

  int rows() const override { return static_cast<int>(feature_.z.size()); }
  std::vector<int> parameter_sizes() const override;
  void evaluate(const double* const* parameters, double* residual,
                double** jacobians) const override;

 private:
  std::shared_ptr<SightingWorkspace> workspace_;
  const Feature& feature_;
};

/// Parameter: the start pose. r = W (x - mean), heading wrapped, W as whitening_of(cov).
class PosePrior final : public Residual {
 public:
  PosePrior(const Eigen::Vector3d& mean, const Eigen::Matrix3d& cov);

  int rows() const override { return 3; }
  std::vector<int> parameter_sizes() const override { return {3}; }
  void evaluate(const double* const* parameters, double* residual,
                double** jacobians) const override;

 private:
  Eigen::Vector3d mean_;
  Eigen::Matrix3d whitening_;
};

/// Parameter: a value. r = (c - mean) / sigma.
class ValuePrior final : public Residual {
 public:
  ValuePrior(double mean, double sigma) : mean_(mean), sigma_(sigma) {}

  int rows() const override { return 1; }
  std::vector<int> parameter_sizes() const override { return {1}; }
  void evaluate(const double* const* parameters, double* residual,
                double** jacobians) const override;

 private:
  double mean_, sigma_;
};

/// Parameters: a value before and after. r = (c' - c) / sigma.
class ValueWalk final : public Residual {
 public:
  explicit ValueWalk(double sigma) : sigma_(sigma) {}

  int rows() const override { return 1; }
  std::vector<int> parameter_sizes() const override { return {1, 1}; }
  void evaluate(const double* const* parameters, double* residual,
                double** jacobians) const override;

 private:
  double sigma_;
};

}  // namespace libslam
