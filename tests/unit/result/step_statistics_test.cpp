#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <libslam/result/step_statistics.hpp>

#include "sample_run.hpp"

namespace libslam {
namespace {

TEST(LogHistogram, QuantilesAreWithinItsResolution) {
  std::mt19937 generator(5);
  std::lognormal_distribution<double> distribution(-1.0, 1.5);
  std::vector<double> values(5000);
  LogHistogram histogram;
  for (double& value : values) histogram.add(value = distribution(generator));
  std::sort(values.begin(), values.end());
  for (const double p : {0.01, 0.5, 0.95, 0.99}) {
    const double exact = values[static_cast<std::size_t>(std::ceil(p * 5000)) - 1];
    EXPECT_NEAR(histogram.quantile(p) / exact, 1.0, 0.0051) << p;
  }
}

TEST(LogHistogram, OutliersAndEmptinessStayInBounds) {
  LogHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), 0.0);
  histogram.add(0.0);
  histogram.add(1e300);
  EXPECT_NEAR(histogram.quantile(0.25), 1e-6, 1e-8);
  EXPECT_GT(histogram.quantile(1.0), 9e5);
}

TEST(StepStatistics, HandComputedFigures) {
  StepStatistics statistics;
  StepRecord step;
  step.step_ms = 1.0;
  statistics.add(step);  // no update
  step = {};
  step.nis = 2.0;
  step.nis_dof = 2;
  step.accepted = 3;
  step.gated = 1;
  step.step_ms = 3.0;
  statistics.add(step);
  step.nis = 100.0;
  step.nis_dof = 4;
  statistics.add(step);
  RunSummary summary;
  statistics.fill(summary);
  EXPECT_EQ(summary.timing.steps, 3);
  EXPECT_EQ(statistics.updates(), 2);
  EXPECT_NEAR(*summary.health.nis_mean, 102.0 / 6.0, 1e-12);
  EXPECT_EQ(*summary.health.nis_in_95, 0.5);
  EXPECT_EQ(*summary.health.gated_fraction, 0.25);
  EXPECT_NEAR(summary.timing.step_ms->mean, 7.0 / 3.0, 1e-12);
  EXPECT_EQ(summary.timing.step_ms->max, 3.0);
}

TEST(StepStatistics, ChiSquareInnovationsLookConsistent) {
  StepStatistics statistics;
  double dof = 0;
  for (const StepRecord& step : sample::make_run(4000, 6).steps) {
    statistics.add(step);
    dof += step.nis_dof;
  }
  RunSummary summary;
  statistics.fill(summary);
  // Sum of chi-squares: variance 2 dof; fraction inside: binomial. Four standard errors each.
  EXPECT_NEAR(*summary.health.nis_mean, 1.0, 4 * std::sqrt(2 / dof));
  EXPECT_NEAR(*summary.health.nis_in_95, 0.95,
              4 * std::sqrt(0.95 * 0.05 / static_cast<double>(statistics.updates())));
}

TEST(StepStatistics, AnEmptyRunHasNoFigures) {
  RunSummary summary;
  StepStatistics().fill(summary);
  EXPECT_FALSE(summary.timing.step_ms || summary.health.nis_mean || summary.health.gated_fraction);
}

}  // namespace
}  // namespace libslam
