#include <cmath>
#include <random>
#include <support/kidnap_world.hpp>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <libslam/association/constellation.hpp>
#include <libslam/association/pose_fit.hpp>
#include <libslam/association/recent_sightings.hpp>

using namespace libslam;

namespace {

constexpr double kPi = 3.14159265358979323846;

Eigen::Matrix2d variance(double sigma) {
  return sigma * sigma * Eigen::Matrix2d::Identity();
}

std::vector<PlanarPoint> points(const std::vector<Eigen::Vector2d>& positions, double sigma) {
  std::vector<PlanarPoint> result;
  for (const auto& p : positions) result.push_back({p, variance(sigma)});
  return result;
}

/// Where the robot sees points of the world.
std::vector<Eigen::Vector2d> seen_from(const Eigen::Vector3d& pose,
                                       const std::vector<Eigen::Vector2d>& world) {
  std::vector<Eigen::Vector2d> seen;
  for (const auto& p : world)
    seen.emplace_back(rotation_of(pose).transpose() * (p - pose.head<2>()));
  return seen;
}

SensorView all_round(double range) {
  return {Eigen::Vector3d::Zero(), range, 2.0 * kPi};
}

}  // namespace

TEST(PoseFit, IsExactWithoutNoiseFromAStartThatIsOff) {
  const Eigen::Vector3d pose(3.0, -2.0, 3.1);
  const std::vector<Eigen::Vector2d> world{{0, 0}, {5, 1}, {2, 6}};
  const auto map = points(world, 0.1), seen = points(seen_from(pose, world), 0.1);
  std::vector<PointPair> pairs;
  for (std::size_t i = 0; i < 3; ++i) pairs.push_back({&seen[i], &map[i]});
  const PoseFit fit = fit_pose(pairs, pose + Eigen::Vector3d(1.0, -1.0, 0.3));
  EXPECT_LT((fit.T_world_robot - pose).norm(), 1e-6);
  EXPECT_LT(fit.mahalanobis2, 1e-9);
}

TEST(PoseFit, ItsCovarianceIsTheSpreadOfTheErrors) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  const Eigen::Vector3d pose(3.0, -2.0, 1.0);
  const std::vector<Eigen::Vector2d> world{{0, 0}, {5, 1}, {2, 6}, {-4, 3}};
  const auto exact = seen_from(pose, world);
  double nees = 0.0, distance2 = 0.0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    auto map = points(world, 0.05), seen = points(exact, 0.1);
    std::vector<PointPair> pairs;
    for (std::size_t i = 0; i < world.size(); ++i) {
      map[i].position += 0.05 * Eigen::Vector2d(normal(random), normal(random));
      seen[i].position += 0.1 * Eigen::Vector2d(normal(random), normal(random));
      pairs.push_back({&seen[i], &map[i]});
    }
    const PoseFit fit = fit_pose(pairs, pose);
    const Eigen::Vector3d error = fit.T_world_robot - pose;
    nees += error.dot(fit.cov.inverse() * error) / kTrials;
    distance2 += fit.mahalanobis2 / kTrials;
  }
  // Means of 2000 chi-square numbers of 3 and 5 degrees of freedom: within four sigma.
  EXPECT_NEAR(nees, 3.0, 4.0 * std::sqrt(6.0 / kTrials));
  EXPECT_NEAR(distance2, 5.0, 4.0 * std::sqrt(10.0 / kTrials));
}

TEST(ConstellationIndex, FindsByDistanceAndByPlace) {
  const auto world = libslam::testing::scattered(60, 50.0, 8);
  const ConstellationIndex index(points(world, 0.1), 25.0, 10.0);
  std::size_t expected = 0;
  for (std::size_t i = 0; i < world.size(); ++i)
    for (std::size_t k = i + 1; k < world.size(); ++k) {
      const double d = (world[i] - world[k]).norm();
      expected += d >= 8.0 && d <= 9.5;
    }
  EXPECT_EQ(index.between(8.0, 9.5).size(), expected);
  EXPECT_TRUE(index.between(25.1, 90.0).empty());
  for (const Eigen::Vector2d& place :
       {Eigen::Vector2d(20, 20), Eigen::Vector2d(-30, 70), Eigen::Vector2d(49, 1)}) {
    std::vector<bool> visited(world.size(), false);
    index.near(place, 6.0, [&](std::size_t k) {
      EXPECT_FALSE(visited[k]);
      visited[k] = true;
    });
    for (std::size_t k = 0; k < world.size(); ++k)
      EXPECT_TRUE(visited[k] || (world[k] - place).norm() > 6.0) << k;
  }
  EXPECT_THROW(ConstellationIndex({}, 0.0, 1.0), std::invalid_argument);
  EXPECT_THROW(ConstellationIndex(points({{NAN, 0.0}}, 0.1), 5.0, 1.0), std::invalid_argument);
}

TEST(Constellation, FindsTheRobotWithoutNoiseAmongObjectsThatAreNotMapped) {
  const auto world = libslam::testing::scattered(80, 100.0, 21);
  const ConstellationIndex index(points(world, 0.05), 50.0, 20.0);
  const Eigen::Vector3d pose(45.0, 55.0, -2.5);
  std::vector<Eigen::Vector2d> visible;
  for (const auto& p : world)
    if ((p - pose.head<2>()).norm() < 20.0) visible.push_back(p);
  ASSERT_GE(visible.size(), 6u);
  auto seen = points(seen_from(pose, visible), 0.1);
  seen.push_back({{7.0, 7.5}, variance(0.1)});
  seen.push_back({{-3.0, 9.5}, variance(0.1)});
  const SensorView view = all_round(20.0);
  const auto match = match_constellation(index, seen, {&view, 1});
  ASSERT_EQ(match.verdict, ConstellationVerdict::kFound);
  EXPECT_LT((match.T_world_robot - pose).norm(), 0.01);
  EXPECT_EQ(match.missed, 0u);
  for (const Pairing& pair : match.pairs) {
    ASSERT_LT(pair.feature, visible.size());
    EXPECT_EQ(world[pair.landmark], visible[pair.feature]);
  }
}

TEST(Constellation, TwoPlacesThatLookAlikeAreAmbiguous) {
  std::vector<Eigen::Vector2d> world = libslam::testing::scattered(8, 15.0, 3);
  const std::size_t place = world.size();
  for (std::size_t i = 0; i < place; ++i) world.emplace_back(world[i] + Eigen::Vector2d(60.0, 0.0));
  const Eigen::Vector3d pose(7.0, 7.0, 0.4);
  const std::vector<Eigen::Vector2d> here(world.begin(), world.begin() + 8);
  const auto seen = points(seen_from(pose, here), 0.05);
  const SensorView view = all_round(15.0);
  const ConstellationIndex twins(points(world, 0.05), 40.0, 20.0);
  EXPECT_EQ(match_constellation(twins, seen, {&view, 1}).verdict, ConstellationVerdict::kAmbiguous);
  // A landmark in only one of the twins, in view and not seen, decides.
  world.emplace_back(67.0, 9.0);
  world.emplace_back(66.0, 5.0);
  world.emplace_back(70.0, 7.5);
  world.emplace_back(64.0, 8.0);
  world.emplace_back(71.0, 4.0);
  world.emplace_back(63.0, 4.0);
  const ConstellationIndex decided(points(world, 0.05), 40.0, 20.0);
  const auto match = match_constellation(decided, seen, {&view, 1});
  EXPECT_EQ(match.verdict, ConstellationVerdict::kFound);
  EXPECT_LT((match.T_world_robot - pose).norm(), 0.05);
}

TEST(Constellation, ThreePointsAreNeverEnoughAndForeignOnesAreNotFound) {
  const auto world = libslam::testing::scattered(100, 100.0, 5);
  const ConstellationIndex index(points(world, 0.05), 60.0, 30.0);
  const SensorView view = all_round(30.0);
  const std::vector<Eigen::Vector2d> first_three(world.begin(), world.begin() + 3);
  const auto three = points(seen_from({50, 50, 1}, first_three), 0.1);
  EXPECT_EQ(match_constellation(index, three, {&view, 1}).verdict, ConstellationVerdict::kTooFew);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto foreign = points(libslam::testing::scattered(6, 40.0, 1000 + seed), 0.2);
    EXPECT_NE(match_constellation(index, foreign, {&view, 1}).verdict, ConstellationVerdict::kFound)
        << seed;
  }
}

TEST(RecentSightings, FusesMovesAndForgets) {
  RecentSightings recent(2);
  const SensorView view = all_round(10.0);
  recent.add(points({{4.0, 0.0}, {0.0, 5.0}}, 0.2), view);
  recent.move({1.0, 0.0, 0.5 * kPi}, Eigen::Matrix3d::Zero());
  ASSERT_EQ(recent.points().size(), 2u);
  EXPECT_LT((recent.points()[0].position - Eigen::Vector2d(0.0, -3.0)).norm(), 1e-12);
  EXPECT_LT((recent.views()[0].T_robot_sensor - Eigen::Vector3d(0.0, 1.0, -0.5 * kPi)).norm(),
            1e-12);
  recent.add(points({{0.2, -3.0}}, 0.2), view);  // the first point again
  ASSERT_EQ(recent.points().size(), 2u);
  EXPECT_LT((recent.points()[0].position - Eigen::Vector2d(0.1, -3.0)).norm(), 1e-12);
  EXPECT_NEAR(recent.points()[0].cov(0, 0), 0.02, 1e-12);
  recent.add({}, view);  // the second was seen two frames ago
  EXPECT_EQ(recent.points().size(), 1u);
  EXPECT_EQ(recent.views().size(), 2u);
}
