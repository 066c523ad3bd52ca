#include <numbers>
#include <tests/support/numeric_jacobian.hpp>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/state/so3.hpp>

using namespace libslam;

namespace {

/// Zero, tiny, on both sides of the change to the series, ordinary, near pi.
std::vector<Eigen::Vector3d> rotation_vectors() {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  std::vector<Eigen::Vector3d> vectors{Eigen::Vector3d::Zero()};
  for (const double angle : {1e-8, 1e-4, 0.299999, 0.300001, 1.3, std::numbers::pi - 1e-7})
    vectors.emplace_back(angle * axis);
  return vectors;
}

}  // namespace

TEST(So3, ExponentialAndLogarithm) {
  for (const Eigen::Vector3d& theta : rotation_vectors()) {
    const Eigen::Matrix3d expected = skew(theta).exp();
    EXPECT_LT((so3_exp(theta).toRotationMatrix() - expected).norm(), 1e-14) << theta.norm();
    EXPECT_LT((so3_log(so3_exp(theta)) - theta).norm(), 1e-14) << theta.norm();
  }
}

// The translation of a twist in SE(3), as the exponential of its algebra.
TEST(So3, LeftJacobianIsTheTranslationOfATwist) {
  const Eigen::Vector3d rho(0.3, -1.0, 2.0);
  for (const Eigen::Vector3d& theta : rotation_vectors()) {
    Eigen::Matrix4d algebra = Eigen::Matrix4d::Zero();
    algebra.topLeftCorner<3, 3>() = skew(theta);
    algebra.topRightCorner<3, 1>() = rho;
    const Eigen::Matrix4d element = algebra.exp();
    EXPECT_LT((so3_left_jacobian(theta) * rho - element.topRightCorner<3, 1>()).norm(), 1e-13)
        << theta.norm();
  }
}

TEST(So3, DerivativeOfTheLeftJacobian) {
  const Eigen::Vector3d u(0.3, -1.0, 2.0);
  for (const Eigen::Vector3d& theta : rotation_vectors()) {
    const auto f = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      return so3_left_jacobian(x) * u;
    };
    const Eigen::MatrixXd numeric = libslam::testing::numeric_jacobian(theta, f);
    EXPECT_LT((so3_left_jacobian_derivative(theta, u) - numeric).cwiseAbs().maxCoeff(), 1e-8)
        << theta.norm();
  }
}
