#include <stdexcept>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <libslam/batch/residuals.hpp>

namespace libslam {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

bool wanted(double** jacobians, std::size_t parameter) {
  return jacobians != nullptr && jacobians[parameter] != nullptr;
}

Eigen::Map<RowMajor> jacobian_at(double** jacobians, std::size_t parameter, Eigen::Index rows,
                                 Eigen::Index cols) {
  return {jacobians[parameter], rows, cols};
}

/// R(phi)^T on x and y, the heading left alone.
Eigen::Matrix3d into_robot_frame(double phi) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-phi).toRotationMatrix();
  return rotation;
}

}  // namespace

MotionResidual::MotionResidual(std::shared_ptr<MotionChain> chain,
                               std::vector<std::optional<MotionAction>> motions)
    : chain_(std::move(chain)), motions_(std::move(motions)) {}

std::vector<int> MotionResidual::parameter_sizes() const {
  std::vector<int> sizes(2 + static_cast<std::size_t>(chain_->wrt_calibration().cols()), 1);
  sizes[0] = sizes[1] = 3;
  return sizes;
}

void MotionResidual::run_chain(const Eigen::Vector3d& pose,
                               const Eigen::VectorXd& calibration) const {
  chain_->start(pose, calibration);
  for (const auto& motion : motions_) chain_->append(motion);
}

void MotionResidual::reweight(const Eigen::Vector3d& pose, const Eigen::VectorXd& calibration) {
  run_chain(pose, calibration);
  const Eigen::Matrix3d R_robot_world = into_robot_frame(pose[2]);
  whitening_ = whitening_of(R_robot_world * chain_->covariance() * R_robot_world.transpose());
}

void MotionResidual::evaluate(const double* const* parameters, double* residual,
                              double** jacobians) const {
  const Eigen::Vector3d before = Eigen::Map<const Eigen::Vector3d>(parameters[0]);
  const Eigen::Vector3d after = Eigen::Map<const Eigen::Vector3d>(parameters[1]);
  Eigen::VectorXd calibration(chain_->wrt_calibration().cols());
  for (Eigen::Index i = 0; i < calibration.size(); ++i) calibration[i] = parameters[2 + i][0];
  run_chain(before, calibration);

  Eigen::Vector3d deviation = after - chain_->end();
  deviation[2] = wrap_angle(deviation[2]);
  const Eigen::Matrix3d R_robot_world = into_robot_frame(before[2]);
  deviation = R_robot_world * deviation;
  Eigen::Map<Eigen::Vector3d>{residual} = whitening_ * deviation;

  const Eigen::Matrix3d by_after = whitening_ * R_robot_world;
  if (wanted(jacobians, 0)) {
    auto by_before = jacobian_at(jacobians, 0, 3, 3);
    by_before = -by_after * chain_->wrt_pose();
    // R(phi)^T turns with the heading.
    by_before.col(2) += whitening_ * Eigen::Vector3d(deviation.y(), -deviation.x(), 0.0);
  }
  if (wanted(jacobians, 1)) jacobian_at(jacobians, 1, 3, 3) = by_after;
  for (Eigen::Index i = 0; i < calibration.size(); ++i)
    if (const auto parameter = static_cast<std::size_t>(2 + i); wanted(jacobians, parameter))
      jacobian_at(jacobians, parameter, 3, 1) = -by_after * chain_->wrt_calibration().col(i);
}

SightingWorkspace::SightingWorkspace(const MeasurementModel& sensor) : model(sensor) {
  BlockSpec spec = model.landmark_spec();
  const int size = storage_dimension(spec);
  if (size != tangent_dimension(spec))
    throw std::invalid_argument("batch optimization needs landmarks with an additive estimate");
  if (spec.name.empty()) spec.name = "landmark";
  pose = state.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, Eigen::Vector3d::Zero(),
                   Eigen::Matrix3d::Zero());
  landmark = state.add(spec, Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size));
}

SightingResidual::SightingResidual(std::shared_ptr<SightingWorkspace> workspace,
                                   const Feature& feature)
    : workspace_(std::move(workspace)), feature_(feature) {}

std::vector<int> SightingResidual::parameter_sizes() const {
  return {3, static_cast<int>(workspace_->state.size(workspace_->landmark))};
}

void SightingResidual::evaluate(const double* const* parameters, double* residual,
                                double** jacobians) const {
  SightingWorkspace& w = *workspace_;
  const Eigen::Index size = w.state.size(w.landmark);
  w.state.set_estimate(w.pose, Eigen::Map<const Eigen::Vector3d>(parameters[0]));
  w.state.set_estimate(w.landmark, Eigen::Map<const Eigen::VectorXd>(parameters[1], size));
  w.model.linearize(w.state, w.pose, w.landmark, feature_, w.linearized);
  const Eigen::Index m = w.linearized.innovation.size();
  const Eigen::LLT<MeasurementMatrix> noise(w.linearized.cov);
  const MeasurementMatrix whitening = noise.matrixL().solve(MeasurementMatrix::Identity(m, m));
  Eigen::Map<Eigen::VectorXd>{residual, m} = whitening * w.linearized.innovation;
  for (const auto& [block, jacobian] : w.linearized.wrt)
    if (const std::size_t parameter = block == w.pose ? 0 : 1; wanted(jacobians, parameter))
      jacobian_at(jacobians, parameter, m, jacobian.cols()) = -whitening * jacobian;
}

PosePrior::PosePrior(const Eigen::Vector3d& mean, const Eigen::Matrix3d& cov)
    : mean_(mean), whitening_(whitening_of(cov)) {}

void PosePrior::evaluate(const double* const* parameters, double* residual,
                         double** jacobians) const {
  Eigen::Vector3d deviation = Eigen::Map<const Eigen::Vector3d>(parameters[0]) - mean_;
  deviation[2] = wrap_angle(deviation[2]);
  Eigen::Map<Eigen::Vector3d>{residual} = whitening_ * deviation;
  if (wanted(jacobians, 0)) jacobian_at(jacobians, 0, 3, 3) = whitening_;
}

void ValuePrior::evaluate(const double* const* parameters, double* residual,
                          double** jacobians) const {
  residual[0] = (parameters[0][0] - mean_) / sigma_;
  if (wanted(jacobians, 0)) jacobians[0][0] = 1.0 / sigma_;
}

void ValueWalk::evaluate(const double* const* parameters, double* residual,
                         double** jacobians) const {
  residual[0] = (parameters[1][0] - parameters[0][0]) / sigma_;
  if (wanted(jacobians, 0)) jacobians[0][0] = -1.0 / sigma_;
  if (wanted(jacobians, 1)) jacobians[1][0] = 1.0 / sigma_;
}

}  // namespace libslam
