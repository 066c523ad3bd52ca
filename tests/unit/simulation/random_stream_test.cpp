#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <libslam/simulation/random_stream.hpp>

namespace libslam {
namespace {

TEST(RandomStream, AgreesWithThePublishedAnswersOfPhilox) {
  // Known-answer tests of Random123: philox4x32-10, counter and key all zero.
  RandomStream zero(0, RandomPurpose::kMotion);
  EXPECT_EQ(zero(), 0xe169c58d6627e8d5U);
  EXPECT_EQ(zero(), 0x9b00dbd8bc57ac4cU);
}

TEST(RandomStream, DependsOnEveryPartOfItsName) {
  const auto first = [](std::uint64_t seed, RandomPurpose purpose, std::uint64_t step,
                        std::uint32_t element) {
    return RandomStream(seed, purpose, step, element)();
  };
  const auto base = first(1, RandomPurpose::kLaser, 2, 3);
  EXPECT_EQ(base, first(1, RandomPurpose::kLaser, 2, 3));
  EXPECT_NE(base, first(2, RandomPurpose::kLaser, 2, 3));
  EXPECT_NE(base, first(1 + (1ULL << 32), RandomPurpose::kLaser, 2, 3));
  EXPECT_NE(base, first(1, RandomPurpose::kStereo, 2, 3));
  EXPECT_NE(base, first(1, RandomPurpose::kLaser, 3, 3));
  EXPECT_NE(base, first(1, RandomPurpose::kLaser, 2 + (1ULL << 32), 3));
  EXPECT_NE(base, first(1, RandomPurpose::kLaser, 2, 4));
}

TEST(RandomStream, NeighbouringStreamsAreStandardNormalAndUncorrelated) {
  constexpr int kCount = 20000;
  double sum = 0.0, squares = 0.0, products = 0.0, before = 0.0;
  for (int i = 0; i < kCount; ++i) {
    RandomStream random(7, RandomPurpose::kRangeBearing, static_cast<std::uint64_t>(i));
    const double x = std::normal_distribution<double>()(random);
    sum += x;
    squares += x * x;
    products += x * before;
    before = x;
  }
  // Four standard deviations of mean, variance and lag-one covariance of n normal numbers.
  const double n = kCount;
  EXPECT_NEAR(sum / n, 0.0, 4.0 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1.0, 4.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(products / n, 0.0, 4.0 / std::sqrt(n));
}

}  // namespace
}  // namespace libslam
