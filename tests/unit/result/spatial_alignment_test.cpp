#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/result/spatial_alignment.hpp>
#include <libslam/state/block.hpp>

#include "spatial_run.hpp"

namespace libslam {
namespace {

using std::numbers::pi;

Eigen::Isometry3d draw_motion() {
  const auto draw = [](int limit) { return *rc::gen::inRange(-limit, limit + 1); };
  const Eigen::Vector3d turn(1e-3 * draw(1800), 1e-3 * draw(1800), 1e-3 * draw(1800));
  return Eigen::Translation3d(draw(1000), draw(1000), draw(1000)) * sample::rotation(turn);
}

RC_GTEST_PROP(SpatialAlignment, FitFindsAnyRigidMotion, ()) {
  const Eigen::Isometry3d T = draw_motion();
  Eigen::Matrix3Xd solid(3, 5), flat(3, 4);
  solid << 0, 3, 3, -1, 2, 0, 0.5, 2, 4, -3, 1, -2, 0, 1, 5;
  flat << 0, 3, 3, -1, 0, 0.5, 2, 4, 0, 0, 0, 0;
  for (const Eigen::Matrix3Xd& from : {solid, flat}) {
    const auto fit = fit_rigid_in_space(from, T * from);
    RC_ASSERT(fit.has_value());
    // Coordinates up to 2e3 m: the rounding of the input times the lever arm.
    RC_ASSERT((*fit * from - T * from).cwiseAbs().maxCoeff() < 1e-9);
    RC_ASSERT((fit->linear() - T.linear()).cwiseAbs().maxCoeff() < 1e-9);
    RC_ASSERT(fit->linear().determinant() > 0.0);  // not a reflection
  }
}

TEST(SpatialAlignment, FitNeedsThreePoints) {
  EXPECT_FALSE(fit_rigid_in_space(Eigen::Matrix3Xd::Zero(3, 2), Eigen::Matrix3Xd::Zero(3, 2)));
}

RC_GTEST_PROP(SpatialAlignment, PlacementCarriesTheEstimateOntoTheTruth, ()) {
  const SpatialPose estimate = transform_pose(draw_motion(), SpatialPose());
  const SpatialPose truth = transform_pose(draw_motion(), SpatialPose());
  const SpatialPose placed = transform_pose(place_on(estimate, truth), estimate);
  RC_ASSERT(pose_difference(placed, truth).norm() < 1e-9);
}

TEST(SpatialAlignment, DifferenceIsTheInverseOfTheChartOfTheState) {
  const BlockSpec spec{"pose", Chart::kSE3, 6, WorldRole::kPose};
  const SpatialPose b{{1, -2, 3}, sample::rotation({0.4, -1.0, 2.0})};
  Eigen::Matrix<double, 6, 1> d;
  d << 0.1, -0.2, 0.3, 0.5, -0.4, 0.2;
  Eigen::VectorXd a(7);
  a << b.position, b.rotation.coeffs();
  boxplus(spec, a, d);
  const SpatialPose moved{a.head<3>(), Eigen::Quaterniond(a[6], a[3], a[4], a[5])};
  EXPECT_LT((pose_difference(moved, b) - d).norm(), 1e-12);
}

TEST(SpatialAlignment, LiftedPosesHaveTheirShadow) {
  const Eigen::Vector3d pose(3, -4, 2.5);
  const SpatialPose lifted = lift_to_space({&pose, 1}).front();
  EXPECT_EQ(lifted.position, Eigen::Vector3d(3, -4, 0));
  EXPECT_LT((shadow_of(lifted) - pose).norm(), 1e-15);
}

TEST(SpatialAlignment, APointOnTheRobotTurnsWithIt) {
  std::vector<SpatialEstimate> robot(1);
  robot[0].pose = {{1, 2, 3}, sample::rotation({0, -pi / 2, 0})};  // forward is up
  const auto moved = path_of_point(robot, {2.0, 0.5});
  EXPECT_LT((moved[0].pose.position - Eigen::Vector3d(1, 2.5, 5)).norm(), 1e-12);
}

// The additive chart of the state moved by 1e-6 each way: error of the difference quotient 1e-10.
TEST(ShadowCovariance, IsTheNumericDerivativeOfTheShadow) {
  const BlockSpec spec{"pose", Chart::kSE3, 6, WorldRole::kPose};
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1e-8, -1e-8, 1e-8), Eigen::Vector3d(0.5, -0.9, 2),
        Eigen::Vector3d(0.3, 0.2, 3.1)}) {
    SpatialEstimate estimate;
    estimate.pose = {{1, 2, 3}, sample::rotation(turn)};
    Eigen::Matrix<double, 3, 6> J;
    for (int k = 0; k < 6; ++k) {
      const auto shadow_at = [&](double step) -> Eigen::Vector3d {
        Eigen::VectorXd x(7);
        x << estimate.pose.position, estimate.pose.rotation.coeffs();
        boxplus(spec, x, step * Eigen::Matrix<double, 6, 1>::Unit(k));
        return shadow_of(SpatialPose{x.head<3>(), Eigen::Quaterniond(x[6], x[3], x[4], x[5])});
      };
      J.col(k) = (shadow_at(1e-6) - shadow_at(-1e-6)) / 2e-6;
    }
    Eigen::Matrix<double, 6, 6> root = Eigen::Matrix<double, 6, 6>::Identity();
    root(0, 5) = 0.3;
    root(4, 1) = -0.5;
    estimate.cov = root * root.transpose();
    EXPECT_LT((shadow_covariance(estimate) - J * estimate.cov * J.transpose()).norm(), 1e-8);
  }
  SpatialEstimate upright;
  upright.pose.rotation = sample::rotation({0, -pi / 2, 0});
  upright.cov.setIdentity();
  EXPECT_LT((shadow_covariance(upright) - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

}  // namespace
}  // namespace libslam
