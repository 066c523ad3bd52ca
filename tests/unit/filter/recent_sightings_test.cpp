#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <libslam/filter/recent_sightings.hpp>

using namespace libslam;

namespace {

SightedPoint point(double x, double y, double sigma = 0.1, std::int64_t id = kNoIdentity) {
  return {id, {{x, y}, sigma * sigma * Eigen::Matrix2d::Identity()}};
}

}  // namespace

TEST(RecentSightings, PointsStayWhereTheyAreWhileTheRobotMoves) {
  RecentSightings sightings(10);
  const std::vector<SightedPoint> seen = {point(3.0, 1.0), point(-2.0, 4.0)};
  sightings.add(seen, {});
  const Eigen::Vector3d increment(0.5, -0.2, 0.7);
  sightings.move(increment, Eigen::Matrix3d::Zero());
  const Eigen::Rotation2Dd R(increment[2]);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const PlanarPoint now = sightings.points()[i];
    EXPECT_LT((R * now.position + increment.head<2>() - seen[i].point.position).norm(), 1e-12);
    EXPECT_TRUE(now.cov.isApprox(seen[i].point.cov));
  }
}

// Covariance after a noisy step against samples of it; 20 000 of them know a variance within 1 %,
// four times that is allowed, and the second-order part of the turn is 1e-4 of it.
TEST(RecentSightings, OdometryNoiseSpreadsThePoints) {
  const Eigen::Vector3d increment(0.5, -0.2, 0.7), sigma(0.05, 0.1, 0.02);
  const Eigen::Vector2d place(3.0, 1.0);
  RecentSightings sightings(10);
  sightings.add(std::vector{point(place.x(), place.y())}, {});
  sightings.move(increment, sigma.cwiseAbs2().asDiagonal());
  const PlanarPoint now = sightings.points()[0];
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Eigen::Matrix2d sampled = Eigen::Matrix2d::Zero();
  constexpr int kSamples = 20000;
  for (int k = 0; k < kSamples; ++k) {
    Eigen::Vector3d moved = increment;
    for (int i = 0; i < 3; ++i) moved[i] += sigma[i] * normal(random);
    const Eigen::Vector2d seen = place + 0.1 * Eigen::Vector2d(normal(random), normal(random));
    const Eigen::Vector2d e =
        Eigen::Rotation2Dd(-moved[2]) * (seen - moved.head<2>()) - now.position;
    sampled += e * e.transpose() / kSamples;
  }
  EXPECT_LT((sampled - now.cov).norm(), 0.05 * now.cov.norm());
}

TEST(RecentSightings, SightingsOfOneObjectAreFused) {
  RecentSightings sightings(10);
  sightings.add(std::vector{point(3.0, 1.0), point(6.0, 1.0)}, {});
  sightings.add(std::vector{point(6.1, 1.0), point(0.0, 5.0)}, {});
  ASSERT_EQ(sightings.size(), 3u);
  EXPECT_EQ(sightings.latest(), (std::vector<std::size_t>{1, 2}));
  EXPECT_NEAR(sightings.points()[1].position.x(), 6.05, 1e-12);
  EXPECT_NEAR(sightings.points()[1].cov(0, 0), 0.005, 1e-12);
}

TEST(RecentSightings, IdentitiesDecideWhereTheyAreKnown) {
  RecentSightings sightings(10);
  sightings.add(std::vector{point(3.0, 1.0, 0.1, 7)}, {});
  sightings.add(std::vector{point(3.0, 1.0, 0.1, 8), point(3.5, 1.0, 0.1, 7)}, {});
  ASSERT_EQ(sightings.size(), 2u);
  EXPECT_EQ(sightings.latest(), (std::vector<std::size_t>{1, 0}));
}

TEST(RecentSightings, ForgetsWhatHasNotBeenSeenForLong) {
  RecentSightings sightings(3);
  sightings.add(std::vector{point(3.0, 1.0), point(0.0, 4.0)}, {});
  for (int k = 0; k < 2; ++k) sightings.add(std::vector{point(0.0, 4.0)}, {});
  EXPECT_EQ(sightings.size(), 2u);
  sightings.add(std::vector{point(0.0, 4.0)}, {});
  ASSERT_EQ(sightings.size(), 1u);
  EXPECT_EQ(sightings.latest().front(), 0u);
  EXPECT_EQ(sightings.views().size(), 3u);
  sightings.clear();
  EXPECT_EQ(sightings.size(), 0u);
  EXPECT_THROW(RecentSightings(0), std::invalid_argument);
}
