#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/result/truth_comparison.hpp>

#include "sample_run.hpp"

namespace libslam {
namespace {

using mrpt::math::TPose2D;
using std::numbers::pi;

std::vector<EstimatedPose> path_of(const sample::Run& run) {
  std::vector<EstimatedPose> path;
  for (const StepRecord& step : run.steps)
    path.push_back({step.index, step.time, step.pose, step.cov});
  return path;
}

std::vector<EstimatedPose> path_of(const std::vector<Eigen::Vector3d>& poses) {
  std::vector<EstimatedPose> path;
  for (const Eigen::Vector3d& pose : poses)
    path.push_back({static_cast<std::int64_t>(path.size()), static_cast<double>(path.size()), pose,
                    Eigen::Matrix3d::Identity()});
  return path;
}

PathErrors compare(const std::vector<EstimatedPose>& path, const Trajectory& truth) {
  return compare_path(path, truth, match_poses(path, truth));
}

TEST(PathErrors, HandComputedRawErrors) {
  // The truth starts at (10, 0) heading +90 degrees, so that the estimate (x, y) belongs at (10 -
  // y, x).
  const auto path = path_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0.1}});
  const Trajectory truth{{0, 1, 2}, {{10, 0, pi / 2}, {10, 1.3, pi / 2}, {10.4, 2, pi / 2}}, {}};
  const PathErrors errors = compare(path, truth);
  ASSERT_TRUE(errors.raw && errors.heading);
  EXPECT_EQ(errors.poses, 3);
  EXPECT_NEAR(errors.raw->rmse_m, std::sqrt((0.09 + 0.16) / 3), 1e-12);
  EXPECT_NEAR(errors.raw->mean_m, 0.7 / 3, 1e-12);
  EXPECT_NEAR(errors.raw->max_m, 0.4, 1e-12);
  EXPECT_NEAR(errors.raw->rmse_x_m, 0.4 / std::sqrt(3), 1e-12);
  EXPECT_NEAR(errors.raw->rmse_y_m, 0.3 / std::sqrt(3), 1e-12);
  EXPECT_NEAR(errors.heading->rmse_rad, 0.1 / std::sqrt(3), 1e-12);
  EXPECT_NEAR(errors.heading->max_rad, 0.1, 1e-12);
}

TEST(PathErrors, HeadingWrapsAtPi) {
  const auto path = path_of({{0, 0, 0}, {1, 0, pi - 0.01}, {2, 0, -pi + 0.02}});
  const Trajectory truth{{0, 1, 2}, {{0, 0, 0}, {1, 0, -pi + 0.01}, {2, 0, pi - 0.02}}, {}};
  const PathErrors errors = compare(path, truth);
  EXPECT_NEAR(errors.heading->max_rad, 0.04, 1e-12);
  EXPECT_NEAR(errors.heading->rmse_rad, std::sqrt((0.0004 + 0.0016) / 3), 1e-12);
}

TEST(PathErrors, HandComputedAlignedErrors) {
  // A square whose diagonal corners are pulled out by 0.1 m: the best rigid fit is the identity.
  const auto path = path_of({{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}});
  const double out = 1 + 0.1 / std::numbers::sqrt2;
  const Trajectory truth{
      {0, 1, 2, 3}, {{out, out, 0}, {-1, 1, 0}, {-out, -out, 0}, {1, -1, 0}}, {}};
  const PathErrors errors = compare(path, truth);
  EXPECT_NEAR(errors.aligned->rmse_m, 0.1 / std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(errors.aligned->max_m, 0.1, 1e-12);
}

RC_GTEST_PROP(PathErrors, RawAndAlignedDoNotDependOnTheFrameOfTheTruth, ()) {
  const sample::Run run = sample::make_run(300, 3);
  const auto path = path_of(run);
  const PathErrors reference = compare(path, run.truth.path);
  const auto draw = [](int limit) { return *rc::gen::inRange(-limit, limit + 1); };
  const TPose2D T(draw(100), draw(100), 1e-3 * draw(3141));
  Trajectory moved = run.truth.path;
  for (Eigen::Vector3d& pose : moved.poses) pose = transform_pose(T, pose);
  const PathErrors errors = compare(path, moved);
  // Rounding at 100 m is 1e-14 m; errors are means of some hundred such terms.
  RC_ASSERT(std::abs(errors.raw->rmse_m - reference.raw->rmse_m) < 1e-11);
  RC_ASSERT(std::abs(errors.aligned->rmse_m - reference.aligned->rmse_m) < 1e-11);
  RC_ASSERT(std::abs(errors.heading->rmse_rad - reference.heading->rmse_rad) < 1e-11);
}

RC_GTEST_PROP(PathErrors, AlignedIsNeverAboveRaw, (unsigned seed)) {
  const sample::Run run = sample::make_run(50, seed);
  const PathErrors errors = compare(path_of(run), run.truth.path);
  RC_ASSERT(errors.aligned->rmse_m <= errors.raw->rmse_m + 1e-12);
}

TEST(PathErrors, PositionsOnlyGiveOnlyTheAlignedFigure) {
  sample::Run run = sample::make_run(100, 4);
  run.truth.path.has_heading = false;
  for (Eigen::Vector3d& pose : run.truth.path.poses) pose.z() = 0.0;
  const auto path = path_of(run);
  const TruthComparison result =
      compare_with_truth(path, run.map, {}, run.truth, LandmarkIdentity::known);
  ASSERT_TRUE(result.path && result.path->aligned);
  EXPECT_FALSE(result.path->raw || result.path->heading || result.relative || result.nees);
  EXPECT_FALSE(result.map->rmse_m);
  EXPECT_TRUE(result.map->rmse_aligned_m);
  EXPECT_THROW(pose_nees(path, run.truth.path, match_poses(path, run.truth.path)),
               std::invalid_argument);
}

TEST(RelativeErrors, ScaleErrorIsSeenAsPercentAndTurnAsDegreesPerMetre) {
  // Estimated: 2 % too long, and a turn of 0.001 rad per metre that does not exist.
  std::vector<Eigen::Vector3d> estimate, real;
  for (int i = 0; i <= 100; ++i) {
    real.emplace_back(i, 0, 0);
    estimate.emplace_back(1.02 * i, 0, 0);
  }
  Trajectory truth{{}, real, {}};
  auto path = path_of(estimate);
  auto errors = compare_relative(path, truth, match_poses(path, truth));
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->distance_m, 10.0);
  EXPECT_EQ(errors->stretches, 91);
  EXPECT_NEAR(errors->trans_percent, 2.0, 1e-9);
  EXPECT_NEAR(errors->rot_deg_per_m, 0.0, 1e-12);

  for (std::size_t i = 0; i < path.size(); ++i) path[i].pose = {real[i].x(), 0, 1e-3 * real[i].x()};
  errors = compare_relative(path, truth, match_poses(path, truth), 20.0);
  EXPECT_NEAR(errors->rot_deg_per_m, 1e-3 * 180 / pi, 1e-12);
  EXPECT_FALSE(compare_relative(path, truth, match_poses(path, truth), 1000.0));
}

TEST(Nees, HandComputedInTheFrameOfTheFilter) {
  // The truth lives in a frame turned by 90 degrees; the error along the filter's x is 0.2, sigma
  // 0.1.
  std::vector<EstimatedPose> path = path_of({{0, 0, 0}, {1.2, 0, 0}, {2, 0, pi - 0.05}});
  for (auto& pose : path) pose.cov = Eigen::Vector3d(0.01, 1.0, 0.0025).asDiagonal();
  path[0].cov.setZero();
  const Trajectory truth{{0, 1, 2}, {{5, 5, pi / 2}, {5, 6, pi / 2}, {5, 7, -pi / 2 + 0.05}}, {}};
  const auto matches = match_poses(path, truth);
  const auto nees = pose_nees(path, truth, matches);
  ASSERT_EQ(nees.size(), 3u);
  EXPECT_TRUE(std::isnan(nees[0]));
  EXPECT_NEAR(nees[1], 4.0, 1e-12);
  EXPECT_NEAR(nees[2], 4.0, 1e-9);  // heading error 0.1 across the wrap, sigma 0.05
  const auto summary = summarize_nees(path, matches, nees);
  EXPECT_EQ(summary->steps, 2);
  EXPECT_NEAR(summary->mean, 4.0, 1e-9);
  EXPECT_EQ(summary->in_95, 1.0);
  EXPECT_FALSE(summary->quarter_mean[0]);
  EXPECT_TRUE(summary->quarter_mean[2] && summary->quarter_mean[3]);
}

// The first motion of a vehicle that cannot go sideways leaves a covariance of rank two, in which
// rounding makes any error look impossible.
TEST(Nees, CovariancesThatAreSingularUpToRoundingHaveNone) {
  std::vector<EstimatedPose> path = path_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  Eigen::Matrix<double, 3, 2> g;
  g << 3.5e-3, 1.7e-5, 9.1e-5, 2.6e-3, 1.2e-6, 6.6e-4;
  path[0].cov.setZero();
  path[1].cov = g * g.transpose();
  path[2].cov = path[1].cov + 1e-9 * Eigen::Matrix3d::Identity();
  const Trajectory truth{{0, 1, 2}, {{0, 0, 0}, {1, 1e-7, 0}, {2, 0, 0}}, {}};
  const auto nees = pose_nees(path, truth, match_poses(path, truth));
  ASSERT_EQ(nees.size(), 3u);
  EXPECT_TRUE(std::isnan(nees[1]));
  EXPECT_TRUE(std::isfinite(nees[2]));
}

TEST(Nees, SampledGaussianErrorsGiveThreeWithinTheoryBounds) {
  constexpr int kSteps = 4000;
  const sample::Run run = sample::make_run(kSteps + 1, 20240611);
  const auto path = path_of(run);
  const auto matches = match_poses(path, run.truth.path);
  const auto summary = summarize_nees(path, matches, pose_nees(path, run.truth.path, matches));
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->steps, kSteps);
  // Variance of a chi-square with 3 dof is 6, of an indicator .95 * .05; four standard errors each.
  EXPECT_NEAR(summary->mean, 3.0, 4 * std::sqrt(6.0 / kSteps));
  EXPECT_NEAR(summary->in_95, 0.95, 4 * std::sqrt(0.95 * 0.05 / kSteps));
  // Density of the chi-square at its median 2.366 is .188: standard error 1 / (2 f sqrt(n)).
  EXPECT_NEAR(summary->median, 2.366, 4 / (2 * 0.188 * std::sqrt(kSteps)));
  for (const auto& mean : summary->quarter_mean) {
    ASSERT_TRUE(mean);
    EXPECT_NEAR(*mean, 3.0, 4 * std::sqrt(6.0 / (kSteps / 4.0)));
  }
}

TEST(CompareWithTruth, CalibrationErrorIsEstimateMinusTruth) {
  GroundTruth truth;
  truth.calibration = {{"scale_left", 1.04}, {"unknown", 1.0}};
  const TruthComparison result = compare_with_truth(
      {}, {}, {{"scale_left", 1.05}, {"scale_right", 1.0}}, truth, LandmarkIdentity::known);
  ASSERT_EQ(result.calibration_error.size(), 1u);
  EXPECT_NEAR(result.calibration_error.at("scale_left"), 0.01, 1e-15);
  EXPECT_FALSE(result.path || result.map || result.nees);
}

}  // namespace
}  // namespace libslam
