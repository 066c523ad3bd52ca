#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/result/alignment.hpp>

namespace libslam {
namespace {

using mrpt::math::TPose2D;
using std::numbers::pi;

std::vector<EstimatedPose> estimates_at(const std::vector<double>& times) {
  std::vector<EstimatedPose> path;
  for (const double time : times)
    path.push_back({static_cast<std::int64_t>(path.size()), time, Eigen::Vector3d::Zero(),
                    Eigen::Matrix3d::Identity()});
  return path;
}

Trajectory truth_at(const std::vector<double>& times) {
  return {times, std::vector<Eigen::Vector3d>(times.size(), Eigen::Vector3d::Zero()), {}};
}

std::vector<std::pair<std::size_t, std::size_t>> pairs(const std::vector<PoseMatch>& matches) {
  std::vector<std::pair<std::size_t, std::size_t>> result;
  for (const PoseMatch& m : matches) result.emplace_back(m.estimate, m.truth);
  return result;
}

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

TEST(MatchPoses, TakesTheNearestTruthWithinHalfItsStep) {
  // Truth every second with a gap from 2 to 10: nothing inside the gap or beyond the ends matches.
  const auto matches = match_poses(estimates_at({-0.6, -0.4, 1.2, 2.4, 5.0, 9.6, 11.4, 13.0}),
                                   truth_at({0, 1, 2, 10, 11, 12}));
  EXPECT_EQ(pairs(matches), (Pairs{{1, 0}, {2, 1}, {3, 2}, {5, 3}, {6, 4}}));
}

TEST(MatchPoses, DenseEstimateUsesEachTrueSampleOnceWithTheNearestEstimate) {
  const auto matches =
      match_poses(estimates_at({0.0, 0.3, 0.6, 0.9, 1.1, 1.4, 1.9}), truth_at({0, 1, 2}));
  EXPECT_EQ(pairs(matches), (Pairs{{0, 0}, {3, 1}, {6, 2}}));
}

TEST(MatchPoses, ByOrderTheStepNumberCounts) {
  auto path = estimates_at({5, 6, 7});
  path[2].step = 5;  // thinned rows keep their step
  Trajectory truth;
  truth.poses.resize(6, Eigen::Vector3d::Zero());
  EXPECT_EQ(pairs(match_poses(path, truth)), (Pairs{{0, 0}, {1, 1}, {2, 5}}));
  truth.poses.resize(7,
                     Eigen::Vector3d::Zero());  // one pose more: it begins before the first motion
  EXPECT_EQ(pairs(match_poses(path, truth)), (Pairs{{0, 1}, {1, 2}, {2, 6}}));
}

TEST(MatchPoses, NothingToMatch) {
  EXPECT_TRUE(match_poses({}, truth_at({0, 1})).empty());
  EXPECT_TRUE(match_poses(estimates_at({0, 1}), Trajectory()).empty());
}

TEST(Alignment, PlacementCarriesTheEstimateOntoTheTruth) {
  const Eigen::Vector3d estimate(1, 2, 3), truth(-4, 0.5, -3);
  const TPose2D T = place_on(estimate, truth);
  EXPECT_LT((transform_pose(T, estimate) - truth).norm(), 1e-12);
  EXPECT_LT((transform_pose(invert(T), truth) - estimate).norm(), 1e-12);
}

RC_GTEST_PROP(Alignment, FitFindsAnyRigidMotion, ()) {
  const auto draw = [](int limit) { return *rc::gen::inRange(-limit, limit + 1); };
  const TPose2D T(draw(1000), draw(1000), 1e-3 * draw(3141));
  Eigen::Matrix2Xd from(2, 4), to(2, 4);
  from << 0, 3, 3, -1, 0, 0.5, 2, 4;
  for (int i = 0; i < 4; ++i) to.col(i) = transform_point(T, from.col(i));
  const auto fit = fit_rigid(from, to);
  RC_ASSERT(fit.has_value());
  // Coordinates up to 1e3 m: the rounding of the input times the lever arm.
  RC_ASSERT(std::hypot(fit->x - T.x, fit->y - T.y) < 1e-9);
  RC_ASSERT(std::abs(std::remainder(fit->phi - T.phi, 2 * pi)) < 1e-11);
}

TEST(Alignment, FitNeedsTwoPoints) {
  EXPECT_FALSE(fit_rigid(Eigen::Matrix2Xd(2, 1), Eigen::Matrix2Xd(2, 1)));
}

TEST(Alignment, APointOnTheRobotTurnsWithIt) {
  auto path = estimates_at({0, 1});
  path[1].pose = {2, 3, pi / 2};
  const auto moved = path_of_point(path, {1.0, 0.5});
  EXPECT_LT((moved[0].pose - Eigen::Vector3d(1, 0.5, 0)).norm(), 1e-12);
  EXPECT_LT((moved[1].pose - Eigen::Vector3d(1.5, 4, pi / 2)).norm(), 1e-12);
}

}  // namespace
}  // namespace libslam
