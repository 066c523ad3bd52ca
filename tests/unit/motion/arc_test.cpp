#include <cmath>
#include <support/numeric_jacobian.hpp>

#include <gtest/gtest.h>

#include <libslam/motion/arc.hpp>

namespace libslam {
namespace {

TEST(Arc, QuarterCircle) {
  const Eigen::Vector3d increment = follow_arc({M_PI_2, 0.0, M_PI_2}).increment;  // radius 1
  EXPECT_NEAR(increment.x(), 1.0, 1e-15);
  EXPECT_NEAR(increment.y(), 1.0, 1e-15);
  EXPECT_EQ(increment.z(), M_PI_2);
}

TEST(Arc, FullCircleReturns) {
  EXPECT_LT(follow_arc({3.0, 0.0, 2.0 * M_PI}).increment.head<2>().norm(), 1e-15);
}

TEST(Arc, SincIsSmoothThroughItsSeries) {
  // sin(x)/x and its derivative in long double do not cancel at these angles.
  for (const double x : {-1.1e-3, 9.99e-4, 1.001e-3, 5e-4, 1e-2, 1.5}) {
    const long double y = x;
    const auto value = static_cast<double>(std::sin(y) / y);
    const auto slope = static_cast<double>((std::cos(y) - std::sin(y) / y) / y);
    EXPECT_NEAR(sinc(x), value, 2e-16);
    // (cos - sinc) / x loses eps / x.
    EXPECT_NEAR(sinc_derivative(x), slope, 2.3e-16 / std::abs(x));
  }
  EXPECT_EQ(sinc(0.0), 1.0);
  EXPECT_EQ(sinc_derivative(0.0), 0.0);
}

TEST(Arc, InverseByRegime) {
  for (const double turn : {0.0, 1e-8, -1e-4, 0.3, -2.0, 3.14159, -3.14159}) {
    for (const double along : {0.0, 1e-8, 0.7, -0.7}) {
      for (const double across : {0.0, 0.2}) {
        const Eigen::Vector3d movement(along, across, turn);
        EXPECT_LT((movement_along_arc(follow_arc(movement).increment) - movement).norm(), 1e-14);
        EXPECT_LT((movement_along_chord(follow_chord(movement).increment) - movement).norm(),
                  1e-14);
      }
    }
  }
}

TEST(Arc, JacobiansByRegime) {
  for (const double turn : {0.0, 1e-8, -9e-4, 1.1e-3, 0.3, -2.0, 3.14159, 5.0}) {
    const Eigen::Vector3d movement(-0.7, 0.2, turn);
    const auto by_arc = testing::numeric_jacobian(movement, [](const Eigen::VectorXd& m) {
      return Eigen::VectorXd(follow_arc(m).increment);
    });
    const auto by_chord = testing::numeric_jacobian(movement, [](const Eigen::VectorXd& m) {
      return Eigen::VectorXd(follow_chord(m).increment);
    });
    EXPECT_LT((follow_arc(movement).jacobian - by_arc).cwiseAbs().maxCoeff(), 1e-9) << turn;
    EXPECT_LT((follow_chord(movement).jacobian - by_chord).cwiseAbs().maxCoeff(), 1e-9) << turn;
  }
}

TEST(Arc, ChordIsMidpointRule) {
  const double theta = 0.4;
  const Eigen::Vector3d increment = follow_chord({0.5, 0.0, 0.2}).increment;
  const Eigen::Vector3d world = rotate_planar(theta) * increment;
  EXPECT_NEAR(world.x(), 0.5 * std::cos(theta + 0.1), 1e-15);  // (S3.1)
  EXPECT_NEAR(world.y(), 0.5 * std::sin(theta + 0.1), 1e-15);
}

}  // namespace
}  // namespace libslam
