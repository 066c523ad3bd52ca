#include <random>

#include <gtest/gtest.h>

#include <libslam/motion/odometry_noise.hpp>

namespace libslam {
namespace {

OdometryNoiseParameters random_parameters(std::mt19937_64& random) {
  std::uniform_real_distribution<double> sigma(0.0, 1.0);
  OdometryNoiseParameters p;
  for (double* value :
       {&p.along_per_sqrt_s, &p.along_per_sqrt_m, &p.along_per_sqrt_rad, &p.across_per_sqrt_s,
        &p.across_per_sqrt_m, &p.turn_per_sqrt_s, &p.turn_per_sqrt_m, &p.turn_per_sqrt_rad}) {
    *value = sigma(random);
  }
  return p;
}

TEST(OdometryNoise, SplittingAnIntervalKeepsTheVariance) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0), both(-3.0, 3.0);
  for (int i = 0; i < 1000; ++i) {
    const OdometryNoise noise(random_parameters(random));
    const double dt = 2.0 * unit(random), ds = both(random), turn = both(random);
    const double part = unit(random), rest = 1.0 - part;
    const Eigen::Vector3d whole = noise.variance(dt, ds, turn).head<3>();
    const Eigen::Vector3d split = noise.variance(part * dt, part * ds, part * turn).head<3>() +
                                  noise.variance(rest * dt, rest * ds, rest * turn).head<3>();
    ASSERT_LE((whole - split).cwiseAbs().maxCoeff(), 1e-14 * (1.0 + whole.maxCoeff()));
  }
}

TEST(OdometryNoise, EveryParameterHasItsUnit) {
  OdometryNoiseParameters p{};
  p.along_per_sqrt_s = 1, p.along_per_sqrt_m = 2, p.along_per_sqrt_rad = 3;
  p.across_per_sqrt_s = 4, p.across_per_sqrt_m = 5;
  p.turn_per_sqrt_s = 6, p.turn_per_sqrt_m = 7, p.turn_per_sqrt_rad = 8;
  p.steering_per_sqrt_s = 9;
  const NoiseVector v = OdometryNoise(p).variance(0.25, -0.5, -2.0);
  EXPECT_DOUBLE_EQ(v[kAlong], 1 * 0.25 + 4 * 0.5 + 9 * 2.0);
  EXPECT_DOUBLE_EQ(v[kAcross], 16 * 0.25 + 25 * 0.5);
  EXPECT_DOUBLE_EQ(v[kTurn], 36 * 0.25 + 49 * 0.5 + 64 * 2.0);
  EXPECT_DOUBLE_EQ(v[kSteering], 81 / 0.25);
}

TEST(OdometryNoise, UnknownIntervalHasNoTimeParts) {
  OdometryNoiseParameters p{};
  p.along_per_sqrt_m = p.turn_per_sqrt_m = p.turn_per_sqrt_rad = p.across_per_sqrt_m = 0.0;
  p.along_per_sqrt_s = p.steering_per_sqrt_s = 1.0;
  EXPECT_EQ(OdometryNoise(p).variance(0.0, 1.0, 1.0), NoiseVector::Zero());
}

}  // namespace
}  // namespace libslam
