#include <numbers>
#include <tests/support/numeric_jacobian.hpp>
#include <tests/unit/batch/batch_world.hpp>

#include <gtest/gtest.h>

#include <libslam/batch/residuals.hpp>
#include <libslam/motion/body_increment_model.hpp>

using namespace libslam;
using namespace libslam::testing;

namespace {

/// Largest difference between the Jacobians of `residual` and central differences at `x`, the
/// parameters one after another.
double jacobian_error(const Residual& residual, const Eigen::VectorXd& x) {
  const std::vector<int> sizes = residual.parameter_sizes();
  const auto pointers = [&](const Eigen::VectorXd& at) {
    std::vector<const double*> list;
    Eigen::Index offset = 0;
    for (const int size : sizes) {
      list.push_back(at.data() + offset);
      offset += size;
    }
    return list;
  };
  const auto value = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
    Eigen::VectorXd r(residual.rows());
    residual.evaluate(pointers(at).data(), r.data(), nullptr);
    return r;
  };
  const Eigen::MatrixXd numeric = numeric_jacobian(x, value);
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> analytic;
  std::vector<double*> jacobians;
  for (const int size : sizes) analytic.emplace_back(residual.rows(), size);
  for (auto& jacobian : analytic) jacobians.push_back(jacobian.data());
  Eigen::VectorXd r(residual.rows());
  residual.evaluate(pointers(x).data(), r.data(), jacobians.data());
  double error = 0.0;
  Eigen::Index column = 0;
  for (const auto& jacobian : analytic) {
    error = std::max(
        error, (jacobian - numeric.middleCols(column, jacobian.cols())).cwiseAbs().maxCoeff());
    column += jacobian.cols();
  }
  return error / (1.0 + numeric.cwiseAbs().maxCoeff());
}

}  // namespace

TEST(Residuals, MotionJacobiansAreExactFarFromTheOptimumToo) {
  CalibrationParameters calibration;
  calibration.scale_left.enabled = calibration.scale_right.enabled = true;
  const EkfSlamParts parts = batch_parts(calibration);
  std::mt19937_64 random(302);
  SlamWorld world;
  std::vector<std::optional<MotionAction>> motions;
  for (int i = 0; i < 4; ++i) motions.emplace_back(world.drive(random, 1.0));
  auto chain = std::make_shared<MotionChain>(*parts.motion, Eigen::Matrix3d::Zero());
  MotionResidual residual(chain, motions);
  residual.reweight({1.0, 2.0, 3.0}, Eigen::Vector2d(1.0, 1.0));
  Eigen::VectorXd x(8);
  x << 1.0, 2.0, 3.0, -0.5, 2.4, 3.3, 1.02, 0.97;  // headings that sum beyond pi
  EXPECT_LT(jacobian_error(residual, x), 1e-7);
}

// Noise belongs to the robot: a shift and a turn of the world change no residual.
TEST(Residuals, MotionDoesNotDependOnTheWorldFrame) {
  const EkfSlamParts parts = batch_parts();
  std::mt19937_64 random(303);
  SlamWorld world;
  auto chain = std::make_shared<MotionChain>(*parts.motion, Eigen::Matrix3d::Zero());
  MotionResidual residual(chain, {world.drive(random, 1.0), world.drive(random, 1.0)});
  residual.reweight(Eigen::Vector3d::Zero(), {});
  const auto value = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    Eigen::Vector3d r;
    const double* parameters[] = {a.data(), b.data()};
    residual.evaluate(parameters, r.data(), nullptr);
    return r;
  };
  const Eigen::Vector3d a(0.1, 0.2, 0.3), b(0.9, 0.5, 0.5), T(3.0, -2.0, 2.9);
  const Eigen::Vector3d moved = value(compose_increment(T, a), compose_increment(T, b));
  EXPECT_GT(moved.norm(), 1.0);
  EXPECT_LT((moved - value(a, b)).norm(), 1e-9);
}

TEST(Residuals, SightingJacobiansAndWhitening) {
  const EkfSlamParts parts = batch_parts();
  auto workspace = std::make_shared<SightingWorkspace>(*parts.measurement);
  Feature feature;
  feature.z = Eigen::Vector2d(3.0, 3.1);
  feature.cov = Eigen::Matrix2d{{0.01, 0.002}, {0.002, 0.0004 + 0.0006}};
  feature.T_robot_sensor = {0.3, -0.2, 0.4};
  const SightingResidual residual(workspace, feature);
  Eigen::VectorXd x(5);
  x << 0.4, -0.3, 1.2, -2.1, 0.9;
  EXPECT_LT(jacobian_error(residual, x), 1e-7);
  Eigen::Vector2d r;
  const double* parameters[] = {x.data(), x.data() + 3};
  residual.evaluate(parameters, r.data(), nullptr);
  const LinearizedMeasurement& seen = workspace->linearized;
  EXPECT_NEAR(r.squaredNorm(),
              seen.innovation.dot(Eigen::Matrix2d(feature.cov).inverse() * seen.innovation), 1e-9);
}

TEST(Residuals, PriorsAndWalks) {
  const Eigen::Matrix3d cov = Eigen::Vector3d(0.04, 0.09, 0.01).asDiagonal();
  EXPECT_LT(jacobian_error(PosePrior({1.0, 2.0, 3.0}, cov), Eigen::Vector3d(1.1, 1.8, -3.1)), 1e-8);
  EXPECT_LT(jacobian_error(ValuePrior(1.0, 0.05), Eigen::VectorXd::Constant(1, 1.1)), 1e-8);
  EXPECT_LT(jacobian_error(ValueWalk(0.02), Eigen::Vector2d(1.0, 1.1)), 1e-8);
  const Eigen::Vector3d at(1.2, 2.3,
                           3.0 - 2.0 * std::numbers::pi);  // the heading is the mean's, once around
  const double* parameters[] = {at.data()};
  Eigen::Vector3d r;
  PosePrior({1.0, 2.0, 3.0}, cov).evaluate(parameters, r.data(), nullptr);
  EXPECT_NEAR(r.squaredNorm(), 2.0, 1e-9);
}
