#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include <libslam/campaign/statistics.hpp>

namespace libslam {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Summarize, InterpolatesQuantilesBetweenOrderStatistics) {
  const Distribution d = summarize({4.0, 1.0, 3.0, 2.0});
  EXPECT_DOUBLE_EQ(d.mean, 2.5);
  EXPECT_DOUBLE_EQ(d.median, 2.5);
  EXPECT_DOUBLE_EQ(d.p95, 3.85);  // between 3 and 4, at .95 * 3 = 2.85
  EXPECT_DOUBLE_EQ(d.sd, std::sqrt(5.0 / 3.0));
}

TEST(Summarize, SingleValueAndNone) {
  const Distribution d = summarize({7.0});
  EXPECT_EQ(d.mean, 7.0);
  EXPECT_EQ(d.p95, 7.0);
  EXPECT_EQ(d.sd, 0.0);
  EXPECT_THROW(summarize({}), std::invalid_argument);
}

TEST(AverageNees, BandOfFiftyRunsIsThePublishedOne) {
  const std::vector<double> run(10, 3.0);
  const auto band = average_nees(std::vector<const std::vector<double>*>(50, &run));
  ASSERT_TRUE(band);
  EXPECT_NEAR(band->lower, 2.36, 0.005);  // half of the last published digit
  EXPECT_NEAR(band->upper, 3.72, 0.005);
  EXPECT_EQ(band->fraction_in_band, 1.0);
  EXPECT_FALSE(band->first_exit);
}

TEST(AverageNees, MeansOverRunsAndFirstExitAbove) {
  const std::vector<double> a{kNan, 3.0, 0.0, 40.0, 3.0, 3.0}, b{kNan, 3.0, 0.0, 50.0, 3.0};
  const auto band = average_nees({&a, &b});
  ASSERT_TRUE(band);
  ASSERT_EQ(band->mean.size(), 5U);  // as long as the shorter run
  EXPECT_TRUE(std::isnan(band->mean[0]));
  EXPECT_EQ(band->mean[3], 45.0);
  EXPECT_EQ(band->first_exit, 3U);
  EXPECT_EQ(band->fraction_in_band, 0.5);  // of the four updates with a value; 0 is below the band
}

TEST(AverageNees, FewerValuesAreJudgedByTheirOwnWiderBand) {
  // 7 lies above the band of four runs [1.10, 5.83] and inside that of one [0.22, 9.35].
  const std::vector<double> one{7.0, 7.0}, none{kNan, 7.0};
  const auto band = average_nees({&one, &none, &none, &none});
  ASSERT_TRUE(band);
  EXPECT_EQ(band->first_exit, 1U);
  EXPECT_EQ(band->fraction_in_band, 0.5);
  EXPECT_FALSE(average_nees({}));
}

TEST(ComparePaired, RatioOfRootMeanSquares) {
  const std::vector<double> a{1.0, 3.0}, b{8.0, 8.0};
  const auto ratio = compare_paired(a, b);
  ASSERT_TRUE(ratio);
  EXPECT_DOUBLE_EQ(ratio->ratio, 0.5);
  EXPECT_EQ(ratio->pairs, 2U);
  EXPECT_DOUBLE_EQ(compare_paired(a, b, false)->ratio, 0.25);
  EXPECT_FALSE(compare_paired({}, {}));
  EXPECT_FALSE(compare_paired(a, std::vector<double>{0.0, 0.0}));
  EXPECT_THROW(compare_paired(a, std::vector<double>{1.0}), std::invalid_argument);
}

TEST(ComparePaired, EqualFiguresGiveExactlyOne) {
  const std::vector<double> a{1.0, 3.0, 0.5};
  const auto ratio = compare_paired(a, a);
  EXPECT_EQ(ratio->ratio, 1.0);
  EXPECT_EQ(ratio->lower, 1.0);
  EXPECT_EQ(ratio->upper, 1.0);
}

TEST(ComparePaired, IntervalCoversTheTrueRatioAndIsDeterministic) {
  // Mean squares of 100 pairs, correlated as those of filters on the same logs are; true ratio .5.
  constexpr int kTrials = 200;
  std::mt19937_64 random(7);
  std::gamma_distribution<double> log_difficulty(4.0, 0.25), noise(9.0, 1.0 / 9.0);
  int covered = 0, below = 0, above = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> a(100), b(100);
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double common = log_difficulty(random);
      a[i] = 0.25 * common * noise(random);
      b[i] = common * noise(random);
    }
    const auto ratio = compare_paired(a, b);
    const auto again = compare_paired(a, b);
    EXPECT_EQ(ratio->lower, again->lower);
    EXPECT_EQ(ratio->upper, again->upper);
    covered += ratio->lower <= 0.5 && 0.5 <= ratio->upper;
    below += ratio->upper < 0.5;
    above += ratio->lower > 0.5;
  }
  // Nominal .95; the percentile bootstrap of 100 pairs falls short of it by about .01. The bound
  // is .94 - 3 sqrt(.94 * .06 / 200). An end that the truth never passes lies too far out: at 2.5 %
  // each the odds of that are .006.
  EXPECT_GE(covered, static_cast<int>(0.89 * kTrials));
  EXPECT_GT(below, 0);
  EXPECT_GT(above, 0);
}

}  // namespace
}  // namespace libslam
