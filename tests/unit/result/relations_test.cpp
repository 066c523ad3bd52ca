#include <cmath>

#include <gtest/gtest.h>

#include <libslam/result/relations.hpp>
#include <libslam/result/truth_comparison.hpp>
#include <libslam/result/truth_json.hpp>

namespace libslam {
namespace {

std::vector<EstimatedPose> path_of(const std::vector<Eigen::Vector3d>& poses) {
  std::vector<EstimatedPose> path;
  for (const Eigen::Vector3d& pose : poses)
    path.push_back({static_cast<std::int64_t>(path.size()), static_cast<double>(path.size()), pose,
                    Eigen::Matrix3d::Zero()});
  return path;
}

TEST(Relations, HandComputed) {
  // Heading +90 degrees: one metre ahead is (0, 1); the second pair turns by -0.2 across pi.
  const auto path =
      path_of({{5, 5, M_PI / 2}, {5, 6.3, M_PI / 2}, {0, 0, M_PI - 0.1}, {0, 0, -M_PI + 0.1}});
  const std::vector<PoseRelation> relations{{0, 1, {1, 0, 0}}, {2, 3, {0, 0.1, 0.3}}};
  const auto errors = compare_relations(path, relations);
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->matched, 2);
  EXPECT_NEAR(errors->trans_mean_m, (0.3 + 0.1) / 2, 1e-12);
  EXPECT_NEAR(errors->trans_std_m, 0.1, 1e-12);
  EXPECT_NEAR(errors->rot_mean_deg, 0.05 * 180 / M_PI, 1e-9);
  EXPECT_NEAR(errors->rot_std_deg, 0.05 * 180 / M_PI, 1e-9);
}

TEST(Relations, TheFrameOfTheRunDoesNotMatter) {
  const std::vector<PoseRelation> relations{{0, 2, {1, 0.5, 0.2}}};
  const auto a = compare_relations(path_of({{0, 0, 0}, {9, 9, 9}, {1, 0.2, 0.1}}), relations);
  const double c = std::cos(1.0), s = std::sin(1.0);
  const auto b = compare_relations(
      path_of({{3, 4, 1}, {9, 9, 9}, {3 + c - 0.2 * s, 4 + s + 0.2 * c, 1.1}}), relations);
  EXPECT_NEAR(a->trans_mean_m, b->trans_mean_m, 1e-12);
  EXPECT_NEAR(a->rot_mean_deg, b->rot_mean_deg, 1e-9);
}

TEST(Relations, TimesMustMeetAPose) {
  const auto path = path_of({{0, 0, 0}, {1, 0, 0}});
  const auto errors = compare_relations(
      path, std::vector<PoseRelation>{{0.0005, 0.9995, {1, 0, 0}}, {0.0, 0.5, {1, 0, 0}}});
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->matched, 1);
  EXPECT_EQ(errors->unmatched, 1);
  EXPECT_EQ(errors->trans_mean_m, 0.0);
  EXPECT_FALSE(compare_relations(path, std::vector<PoseRelation>{{7, 8, {1, 0, 0}}}));
  EXPECT_FALSE(compare_relations(path_of({}), std::vector<PoseRelation>{{0, 1, {1, 0, 0}}}));
}

TEST(Relations, OfPosesOfOneTimeTheLastCounts) {
  auto path = path_of({{0, 0, 0}, {5, 0, 0}, {1, 0, 0}});
  path[1].time = path[2].time;
  const auto errors = compare_relations(path, std::vector<PoseRelation>{{0, 2.0001, {1, 0, 0}}});
  EXPECT_EQ(errors->trans_mean_m, 0.0);
}

TEST(Relations, OfASmoothedPath) {
  const Trajectory path{{0, 1}, {{0, 0, 0}, {1.25, 0, 0}}, {}};
  const std::vector<PoseRelation> relations{{0, 1, {1, 0, 0}}};
  TruthComparison comparison;
  comparison.relations_smoothed = compare_relations(path, relations);
  ASSERT_TRUE(comparison.relations_smoothed);
  EXPECT_NEAR(comparison.relations_smoothed->trans_mean_m, 0.25, 1e-12);
  const auto json = truth_to_json(comparison);
  EXPECT_EQ(truth_from_json(json).relations_smoothed->trans_mean_m, 0.25);
}

/// A straight drive of which only the path as it was known at the end is straight.
TEST(SmoothedPath, IsComparedWithTheSameTruth) {
  GroundTruth truth;
  Trajectory smoothed;
  std::vector<Eigen::Vector3d> driven;
  for (int k = 0; k < 11; ++k) {
    truth.path.times.push_back(k);
    truth.path.poses.emplace_back(k, 2, 0);
    smoothed.times.push_back(k);
    smoothed.poses.emplace_back(0, k + (k > 5 ? 0.3 : 0.0), M_PI / 2);
    driven.emplace_back(0, k + (k > 5 ? 0.6 : 0.0), M_PI / 2);
  }
  truth.relations = {{0, 10, {10, 0, 0}}};
  const auto estimate = path_of(driven);
  TruthComparison comparison =
      compare_with_truth(estimate, {}, {}, truth, LandmarkIdentity::unknown);
  EXPECT_FALSE(comparison.path_smoothed);
  compare_smoothed(smoothed, estimate, truth, {}, comparison);
  ASSERT_TRUE(comparison.path_smoothed && comparison.path_smoothed->raw);
  EXPECT_EQ(comparison.path_smoothed->poses, 11);
  EXPECT_NEAR(comparison.path_smoothed->raw->max_m, 0.3, 1e-12);
  EXPECT_NEAR(comparison.path->raw->max_m, 0.6, 1e-12);
  EXPECT_NEAR(comparison.relations_smoothed->trans_mean_m, 0.3, 1e-12);
  const TruthComparison read = truth_from_json(truth_to_json(comparison));
  ASSERT_TRUE(read.path_smoothed && read.path_smoothed->raw);
  EXPECT_EQ(read.path_smoothed->raw->rmse_m, comparison.path_smoothed->raw->rmse_m);
}

TEST(SmoothedPath, TheWindowIsThatOfTheSteps) {
  GroundTruth truth;
  Trajectory smoothed;
  std::vector<Eigen::Vector3d> driven;
  for (int k = 0; k < 11; ++k) {
    truth.path.times.push_back(k);
    truth.path.poses.emplace_back(k, 0, 0);
    driven.emplace_back(k, 0, 0);
    if (k % 2 != 0) continue;  // not every step is remembered
    smoothed.times.push_back(k);
    smoothed.poses.emplace_back(k, k == 8 ? 0.5 : 0.0, 0);
  }
  ComparisonRules rules;
  rules.window.last_step = 7;
  TruthComparison comparison;
  compare_smoothed(smoothed, path_of(driven), truth, rules, comparison);
  ASSERT_TRUE(comparison.path_smoothed);
  EXPECT_EQ(comparison.path_smoothed->poses, 4);
  EXPECT_NEAR(comparison.path_smoothed->raw->max_m, 0.0, 1e-12);
  rules.window.last_step = 8;
  compare_smoothed(smoothed, path_of(driven), truth, rules, comparison);
  EXPECT_NEAR(comparison.path_smoothed->raw->max_m, 0.5, 1e-12);
}

// As the kf-slam demo of MRPT: a truth without times, and many steps with the same time.
TEST(SmoothedPath, StepsOfOneTimeAreToldApartByTheirOrder) {
  GroundTruth truth;
  Trajectory smoothed;
  std::vector<Eigen::Vector3d> driven;
  for (int k = 0; k < 6; ++k) {
    truth.path.poses.emplace_back(k, 0, 0);
    driven.emplace_back(k, 0, 0);
    smoothed.times.push_back(k / 3);
    smoothed.poses.emplace_back(k, 0, 0);
  }
  auto estimate = path_of(driven);
  for (std::size_t k = 0; k < estimate.size(); ++k) estimate[k].time = smoothed.times[k];
  TruthComparison comparison;
  compare_smoothed(smoothed, estimate, truth, {}, comparison);
  ASSERT_TRUE(comparison.path_smoothed);
  EXPECT_EQ(comparison.path_smoothed->poses, 6);
  EXPECT_EQ(comparison.path_smoothed->raw->max_m, 0.0);
}

TEST(Relations, PartOfTheComparisonAndOfItsJson) {
  GroundTruth truth;
  EXPECT_TRUE(truth.empty());
  truth.relations = {{0, 1, {1, 0, 0}}};
  EXPECT_FALSE(truth.empty());
  const auto path = path_of({{0, 0, 0}, {1.5, 0, 0.1}});
  const TruthComparison comparison =
      compare_with_truth(path, {}, {}, truth, LandmarkIdentity::unknown);
  ASSERT_TRUE(comparison.relations);
  EXPECT_NEAR(comparison.relations->trans_mean_m, 0.5, 1e-12);
  const auto json = truth_to_json(comparison);
  EXPECT_EQ(json["relations"]["trans_mean_m"], comparison.relations->trans_mean_m);
  const TruthComparison back = truth_from_json(json);
  ASSERT_TRUE(back.relations);
  EXPECT_EQ(back.relations->rot_mean_deg, comparison.relations->rot_mean_deg);
  EXPECT_EQ(back.relations->matched, 1);
}

}  // namespace
}  // namespace libslam
