#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/result/spatial_metrics.hpp>
#include <libslam/result/truth_comparison.hpp>

#include "spatial_run.hpp"

namespace libslam {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using std::numbers::pi;

const Isometry3d kMoved =
    Eigen::Translation3d(100, -50, 7) * sample::rotation(Vector3d(0.7, -0.4, 2.0));

TruthComparison compare(const sample::Run& run, const ComparisonRules& rules = {}) {
  return compare_with_truth(sample::path_of_spatial(run), run.map, {}, run.truth,
                            LandmarkIdentity::known, rules);
}

/// Three poses on a line of 4 m, the second and third of which are off by `offset`.
sample::Run three_poses() {
  sample::Run run;
  for (int k = 0; k < 3; ++k) {
    StepRecord step;
    step.index = k;
    step.time = k;
    step.spatial.emplace().pose = {Vector3d(2.0 * k, 0, 0.5 * k), sample::rotation({0.2, 0, 0.4})};
    run.truth.path.times.push_back(k);
    run.truth.path.spatial.push_back(step.spatial->pose);
    run.steps.push_back(step);
  }
  run.truth.path.poses.resize(3);
  run.steps[1].spatial->pose.position.x() += 0.3;
  run.steps[2].spatial->pose.position.z() -= 0.4;
  SpatialPose& last = run.steps[2].spatial->pose;
  last.rotation = sample::rotation({0, 0.1, 0}) * last.rotation;
  return run;
}

TEST(SpatialPathErrors, HandComputedRawErrors) {
  const PathErrors errors = *compare(three_poses()).path;
  ASSERT_TRUE(errors.raw && errors.rotation && errors.drift_percent);
  EXPECT_FALSE(errors.heading);
  EXPECT_EQ(errors.poses, 3);
  EXPECT_NEAR(errors.raw->rmse_m, std::sqrt((0.09 + 0.16) / 3), 1e-12);
  EXPECT_NEAR(errors.raw->mean_m, 0.7 / 3, 1e-12);
  EXPECT_NEAR(errors.raw->max_m, 0.4, 1e-12);
  EXPECT_NEAR(errors.raw->rmse_x_m, 0.3 / std::sqrt(3), 1e-12);
  EXPECT_NEAR(errors.raw->rmse_y_m, 0.0, 1e-12);
  EXPECT_NEAR(*errors.raw->rmse_z_m, 0.4 / std::sqrt(3), 1e-12);
  EXPECT_NEAR(errors.rotation->rmse_rad, 0.1 / std::sqrt(3), 1e-12);
  EXPECT_NEAR(errors.rotation->max_rad, 0.1, 1e-12);
  EXPECT_NEAR(*errors.drift_percent, 100 * 0.4 / (2 * std::sqrt(4.25)), 1e-9);
}

TEST(SpatialPathErrors, NeitherRawNorAlignedDependOnTheFrameOfTheTruth) {
  sample::Run run = sample::make_spatial_run(300, 3);
  const TruthComparison reference = compare(run);
  sample::move_truth(run, kMoved);
  const TruthComparison moved = compare(run);
  EXPECT_NEAR(moved.path->raw->rmse_m, reference.path->raw->rmse_m, 1e-10);
  EXPECT_NEAR(moved.path->aligned->rmse_m, reference.path->aligned->rmse_m, 1e-10);
  EXPECT_LT(moved.path->aligned->rmse_m, moved.path->raw->rmse_m);
  EXPECT_NEAR(moved.path->rotation->rmse_rad, reference.path->rotation->rmse_rad, 1e-10);
  EXPECT_NEAR(moved.relative->trans_percent, reference.relative->trans_percent, 1e-8);
  EXPECT_NEAR(moved.nees->mean, reference.nees->mean, 1e-6);
  EXPECT_NEAR(*moved.map->rmse_m, *reference.map->rmse_m, 1e-10);
  EXPECT_NEAR(*moved.map->rmse_aligned_m, *reference.map->rmse_aligned_m, 1e-10);
  EXPECT_FALSE(moved.placement);
  EXPECT_LT((moved.spatial_placement->matrix() - kMoved.matrix()).norm(), 1e-9);
}

TEST(SpatialRelativeErrors, ScaleErrorIsSeenAsPercentAndTurnAsDegreesPerMetre) {
  // Steps of exactly 3 m.
  const Vector3d along(2, -1, 2), axis = Vector3d(1, 2, 2) / 3;
  Trajectory truth;
  std::vector<SpatialEstimate> longer(101), turning(101);
  std::vector<PoseMatch> matches;
  for (std::size_t i = 0; i <= 100; ++i) {
    const auto s = static_cast<double>(i);
    truth.spatial.push_back({s * along, Eigen::Quaterniond::Identity()});
    longer[i].pose.position = 1.02 * s * along;
    turning[i].pose = {s * along, sample::rotation(3e-3 * s * axis)};
    matches.push_back({i, i});
  }
  EXPECT_EQ(compare_relative(longer, truth, matches)->distance_m, 20.0);
  const auto scaled = compare_relative(longer, truth, matches, 30.0);
  EXPECT_EQ(scaled->stretches, 91);
  EXPECT_NEAR(scaled->trans_percent, 2.0, 1e-9);
  EXPECT_NEAR(scaled->rot_deg_per_m, 0.0, 1e-9);
  const auto turned = compare_relative(turning, truth, matches, 30.0);
  EXPECT_NEAR(turned->rot_deg_per_m, 1e-3 * 180 / pi, 1e-9);
  EXPECT_FALSE(compare_relative(longer, truth, matches, 1000.0));
}

TEST(SpatialNees, HandComputedInTheFrameOfTheFilter) {
  // The truth lives in another frame; errors along the filter's z and about the filter's x.
  sample::Run run = three_poses();
  for (StepRecord& step : run.steps) {
    step.spatial->pose = run.truth.path.spatial[static_cast<std::size_t>(step.index)];
    step.spatial->cov.diagonal() << 1, 1, 0.01, 0.0025, 1, 1;
  }
  run.steps[0].spatial->cov.setZero();
  run.steps[1].spatial->pose.position.z() += 0.2;
  Eigen::Quaterniond& q = run.steps[2].spatial->pose.rotation;
  q = sample::rotation({0.15, 0, 0}) * q;
  q.coeffs() = -q.coeffs();  // the same rotation
  sample::move_truth(run, kMoved);
  const auto path = sample::path_of_spatial(run);
  const auto matches = match_poses(path.poses, run.truth.path);
  const auto nees = pose_nees(path.spatial, run.truth.path, matches, kMoved);
  ASSERT_EQ(nees.size(), 3u);
  EXPECT_TRUE(std::isnan(nees[0]));
  EXPECT_NEAR(nees[1], 4.0, 1e-9);
  EXPECT_NEAR(nees[2], 9.0, 1e-9);
}

TEST(SpatialNees, SampledGaussianErrorsGiveSixWithinTheoryBounds) {
  constexpr int kSteps = 4000;
  sample::Run run = sample::make_spatial_run(kSteps + 1, 20261127);
  sample::move_truth(run, kMoved);
  const auto nees = compare(run).nees;
  ASSERT_TRUE(nees);
  EXPECT_EQ(nees->dof, 6);
  EXPECT_EQ(nees->steps, kSteps);
  // Variance of a chi-square with 6 dof is 12, of an indicator .95 * .05; four standard errors
  // each.
  EXPECT_NEAR(nees->mean, 6.0, 4 * std::sqrt(12.0 / kSteps));
  EXPECT_NEAR(nees->in_95, 0.95, 4 * std::sqrt(0.95 * 0.05 / kSteps));
  EXPECT_NEAR(nees->coverage_95, 0.95, 4 * std::sqrt(0.95 * 0.05 / kSteps));
  // Density of the chi-square at its median 5.348 is .1233: standard error 1 / (2 f sqrt(n)).
  EXPECT_NEAR(nees->median, 5.348, 4 / (2 * 0.1233 * std::sqrt(kSteps)));
}

TEST(SpatialComparison, ARunInAKnownMapIsNotPlaced) {
  constexpr int kSteps = 4000;
  sample::Run run = sample::make_spatial_run(kSteps, 5, false);
  const TruthComparison first = compare(run), none = compare(run, {Placement::none});
  // Sum of the position variances; the error of the first pose would come on top with a placement.
  const Eigen::Matrix3d cov = run.steps[1].spatial->cov.topLeftCorner<3, 3>();
  const double square = cov.trace();
  // Variance of the mean of |e|^2 is 2 tr(cov^2) / n.
  EXPECT_NEAR(none.path->raw->rmse_m * none.path->raw->rmse_m, square,
              4 * std::sqrt(2 * (cov * cov).trace() / kSteps));
  EXPECT_GT(first.path->raw->rmse_m, none.path->raw->rmse_m);
  EXPECT_NEAR(none.nees->mean, 6.0, 4 * std::sqrt(12.0 / kSteps));
  EXPECT_EQ(none.nees->steps, kSteps);
  EXPECT_EQ(none.spatial_placement->matrix(), Eigen::Matrix4d::Identity());
  run.truth.path.has_heading = false;  // positions suffice where nothing is placed
  EXPECT_EQ(compare(run, {Placement::none}).path->raw->rmse_m, none.path->raw->rmse_m);
}

TEST(SpatialComparison, AWindowTakesItsStepsAndThePlacementOfTheWholeRun) {
  sample::Run run = sample::make_spatial_run(100, 6);
  sample::move_truth(run, kMoved);
  for (StepRecord& step : run.steps)
    if (step.index >= 40) step.spatial->pose.position.z() += 1.0;
  const TruthComparison all = compare(run);
  ComparisonRules rules;
  rules.window.first_step = 40;
  rules.window.last_step = 59;
  const TruthComparison window = compare(run, rules);
  EXPECT_EQ(window.path->poses, 20);
  EXPECT_EQ(window.nees->steps, 20);
  EXPECT_NEAR(window.path->raw->mean_m, 1.0, 0.1);  // and not 0, as placed in the window
  EXPECT_EQ(window.spatial_placement->matrix(), all.spatial_placement->matrix());
  rules.window = {};
  rules.window.from_s = 3.95;  // steps are 0.1 s apart
  rules.window.to_s = 5.95;
  EXPECT_EQ(compare(run, rules).path->raw->rmse_m, window.path->raw->rmse_m);
  rules.window.from_s = 1000.0;
  EXPECT_FALSE(compare(run, rules).path);
}

TEST(SpatialComparison, APlanarTruthIsTheGroundAndPlanarPositionsMeetTheShadow) {
  sample::Run run = sample::make_spatial_run(50, 7);
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    SpatialPose& pose = run.steps[i].spatial->pose;
    pose = {{static_cast<double>(i), 0, i == 0 ? 0.0 : 0.2}, Eigen::Quaterniond::Identity()};
    run.steps[i].pose = run.truth.path.poses[i] = shadow_of(pose);
  }
  run.truth.path.spatial.clear();
  const TruthComparison lifted = compare(run);
  EXPECT_NEAR(lifted.path->raw->max_m, 0.2, 1e-12);
  ASSERT_TRUE(lifted.path->rotation);
  run.truth.path.has_heading = false;
  const TruthComparison shadow = compare(run);
  EXPECT_FALSE(shadow.path->raw || shadow.path->aligned->rmse_z_m || shadow.nees);
  EXPECT_NEAR(shadow.path->aligned->rmse_m, 0.0, 1e-12);
  EXPECT_TRUE(shadow.placement && !shadow.spatial_placement);
}

TEST(SpatialComparison, ShadowsOfARunInSpaceStayComparable) {
  const sample::Run run = sample::make_spatial_run(100, 8);
  const auto path = sample::path_of_spatial(run);
  const TruthComparison planar =
      compare_with_truth(path.poses, run.map, {}, run.truth, LandmarkIdentity::known);
  EXPECT_TRUE(planar.path->heading && !planar.path->rotation && planar.placement);
  EXPECT_EQ(planar.nees->dof, 3);
}

TEST(SpatialMapErrors, HeightCounts) {
  sample::Run run = sample::make_spatial_run(10, 9);
  LandmarkMap map;
  for (const TrueLandmark& landmark : run.truth.landmarks)
    map.add({landmark.id, "point", landmark.position + Vector3d(0, 0, landmark.id == 3 ? 0.5 : 0.0),
             Eigen::Matrix3d::Identity(), 1});
  const Isometry3d identity = Isometry3d::Identity();
  const auto n = static_cast<double>(run.truth.landmarks.size());
  auto errors =
      compare_map_in_space(map, run.truth.landmarks, LandmarkIdentity::known, identity, true);
  EXPECT_NEAR(*errors->rmse_m, 0.5 / std::sqrt(n), 1e-12);
  EXPECT_LT(*errors->rmse_aligned_m, *errors->rmse_m);
  errors =
      compare_map_in_space(map, run.truth.landmarks, LandmarkIdentity::unknown, identity, true);
  EXPECT_NEAR(*errors->rmse_m, 0.5 / std::sqrt(n), 1e-12);
  EXPECT_NEAR(*compare_map(map, run.truth.landmarks, LandmarkIdentity::known,
                           mrpt::math::TPose2D(0, 0, 0), true)
                   ->rmse_m,
              0.0, 1e-12);
}

}  // namespace
}  // namespace libslam
