#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/state/block.hpp>
#include <libslam/state/chi_square.hpp>

using namespace libslam;

namespace {

const BlockSpec kSpecs[] = {
    {"v", Chart::kVector, 3}, {"a", Chart::kAngle}, {"p", Chart::kSE2}, {"q", Chart::kSE3}};

Eigen::VectorXd identity_of(const BlockSpec& spec) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(storage_dimension(spec));
  if (spec.chart == Chart::kSE3) x[6] = 1.0;
  return x;
}

double draw(double scale) {
  return scale * (*rc::gen::inRange(-1000000, 1000001)) * 1e-6;
}

}  // namespace

TEST(Block, WrapKeepsPiAndMapsMinusPi) {
  EXPECT_DOUBLE_EQ(wrap_angle(std::numbers::pi), std::numbers::pi);
  EXPECT_DOUBLE_EQ(wrap_angle(-std::numbers::pi), std::numbers::pi);
  EXPECT_NEAR(wrap_angle(3.0 * std::numbers::pi + 0.1), -std::numbers::pi + 0.1, 1e-14);
  EXPECT_DOUBLE_EQ(wrap_angle(0.25), 0.25);
}

RC_GTEST_PROP(Block, BoxminusInvertsBoxplus, ()) {
  for (const BlockSpec& spec : kSpecs) {
    Eigen::VectorXd x = identity_of(spec);
    Eigen::VectorXd first(tangent_dimension(spec)), second(tangent_dimension(spec));
    for (auto& value : first) value = draw(1.5);
    for (auto& value : second) value = draw(1.5);
    boxplus(spec, x, first);
    Eigen::VectorXd moved = x;
    boxplus(spec, moved, second);
    // Rotations of at most 1.5 * sqrt(3) < pi rad are inside the injectivity radius.
    const Eigen::VectorXd difference = boxminus(spec, moved, x);
    RC_ASSERT((difference - second).norm() < 1e-12);
  }
}

TEST(Block, RotationStaysUnitAndTinyStepsAreExact) {
  const BlockSpec& spec = kSpecs[3];
  Eigen::VectorXd x = identity_of(spec);
  const Eigen::VectorXd step = Eigen::VectorXd::Constant(6, 1e-9);
  boxplus(spec, x, step);
  EXPECT_NEAR(x.tail<4>().norm(), 1.0, 1e-15);
  EXPECT_LT((boxminus(spec, x, identity_of(spec)) - step).norm(), 1e-20);
}

TEST(ChiSquare, QuantilesOfTheTables) {
  EXPECT_NEAR(chi_square_quantile(0.95, 2), -2.0 * std::log(0.05), 1e-12);
  EXPECT_NEAR(chi_square_quantile(0.975, 150), 185.800, 1e-3);  // 3.716 * 50 in spec S1
  EXPECT_NEAR(chi_square_quantile(0.025, 150), 117.985, 1e-3);  // 2.360 * 50
  EXPECT_NEAR(chi_square_quantile(1.0 - 1e-13, 2), 59.87, 0.01);
  EXPECT_TRUE(std::isinf(chi_square_quantile(1.0, 2)));
  EXPECT_NEAR(chi_square_probability(chi_square_quantile(0.3, 5), 5), 0.3, 1e-12);
  EXPECT_THROW(chi_square_quantile(1.5, 2), std::invalid_argument);
  EXPECT_THROW(chi_square_quantile(0.5, 0), std::invalid_argument);
}
