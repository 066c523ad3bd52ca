#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <libslam/frontend/scan_matching.hpp>

namespace libslam {
namespace {

using Scan = mrpt::obs::CObservation2DRangeScan;
using Eigen::Vector2d;
using Eigen::Vector3d;
struct Wall {
  Vector2d a, b;
};

/// 8 m x 6 m with a pillar and an open door.
const std::vector<Wall> kRoom = {{{-3, -3}, {5, -3}}, {{5, -3}, {5, 1}},   {{5, 2}, {5, 3}},
                                 {{5, 3}, {-3, 3}},   {{-3, 3}, {-3, -3}}, {{2, 1}, {3, 1}},
                                 {{3, 1}, {3, 2}},    {{3, 2}, {2, 2}},    {{2, 2}, {2, 1}},
                                 {{8, 0}, {8, 3}}};
/// Two walls without an end in sight.
const std::vector<Wall> kCorridor = {{{-500, -1}, {500, -1}}, {{-500, 1}, {500, 1}}};

double cast(const std::vector<Wall>& walls, const Vector2d& from, double heading) {
  const Vector2d u(std::cos(heading), std::sin(heading));
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : walls) {
    Eigen::Matrix2d basis;
    basis << u, wall.a - wall.b;
    if (std::abs(basis.determinant()) < 1e-12) continue;
    const Vector2d at = basis.inverse() * (wall.a - from);
    if (at[0] > 0.0 && at[1] >= 0.0 && at[1] <= 1.0) nearest = std::min(nearest, at[0]);
  }
  return nearest;
}

/// What a scanner 20 cm before the centre of the robot sees over 180 degrees, twice a degree.
Scan scan_at(const std::vector<Wall>& walls, const Vector3d& robot, double sigma,
             std::mt19937_64& random) {
  constexpr std::size_t kBeams = 361;
  std::normal_distribution<double> normal;
  Scan scan;
  scan.aperture = static_cast<float>(kPi);
  scan.maxRange = 81.0F;
  scan.sensorPose = mrpt::poses::CPose3D(0.2, 0.0, 0.3, 0.0, 0.0, 0.0);
  scan.resizeScan(kBeams);
  const Vector2d origin = robot.head<2>() + 0.2 * Vector2d(std::cos(robot[2]), std::sin(robot[2]));
  for (std::size_t i = 0; i < kBeams; ++i) {
    const double bearing = kPi * (static_cast<double>(i) / (kBeams - 1) - 0.5);
    const double range = cast(walls, origin, robot[2] + bearing) + sigma * normal(random);
    scan.setScanRange(i, static_cast<float>(range));
    scan.setScanRangeValidity(i, range < 30.0);
  }
  return scan;
}

ScanMatchingParameters without_floor() {
  ScanMatchingParameters parameters;
  parameters.floor_xy = parameters.floor_heading_deg = 0.0;
  return parameters;
}

/// A guess that is known to 10 cm and 6 degrees only.
const Eigen::Matrix3d kVague = Vector3d(100.0, 100.0, 100.0).asDiagonal();

std::optional<ScanMatch> match(ScanMatcher& matcher, const Scan& reference, const Scan& scan,
                               const Vector3d& guess) {
  if (!matcher.look(reference)) return std::nullopt;
  matcher.renew_reference();
  if (!matcher.look(scan)) return std::nullopt;
  return matcher.match(guess, kVague);
}

TEST(ScanMatching, RecoversMotionsOfNoiselessScans) {
  std::mt19937_64 none(1);
  ScanMatcher matcher(without_floor());
  for (const Vector3d& T : {Vector3d(0, 0, 0), Vector3d(0.2, 0.0, 0.0), Vector3d(-0.1, 0.05, 0.14),
                            Vector3d(0.05, -0.1, -0.2)}) {
    const auto found = match(matcher, scan_at(kRoom, {0, 0, 0}, 0.0, none),
                             scan_at(kRoom, T, 0.0, none), T + Vector3d(0.05, -0.04, 0.06));
    ASSERT_TRUE(found);
    const Vector3d error = Vector3d(0.05, -0.04, 0.06) + found->information.inverse() * found->pull;
    EXPECT_LT(error.norm(), 1e-4) << T.transpose();
    EXPECT_GT(found->fitting, 0.9);
  }
}

// Errors against the covariance that the match claims. The mean of N chi-squares of 3 degrees lies
// within 3 +- 3 sqrt(6 / N); the pairs are treated as if only their own points were noisy twice, so
// the claim may be pessimistic, down to half the variance.
TEST(ScanMatching, KnowsItsErrorInNoise) {
  constexpr int kRuns = 200;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> way(-0.15, 0.15);
  ScanMatcher matcher(without_floor());
  double nees = 0.0;
  int outside = 0;
  for (int i = 0; i < kRuns; ++i) {
    const Vector3d T(way(random), way(random), way(random)), off(0.03, -0.02, 0.03);
    const auto found = match(matcher, scan_at(kRoom, {0, 0, 0}, 0.02, random),
                             scan_at(kRoom, T, 0.02, random), T + off);
    ASSERT_TRUE(found);
    const Vector3d error = off + found->information.inverse() * found->pull;
    const double distance2 = error.dot(found->information * error);
    nees += distance2 / kRuns;
    outside += distance2 > 16.27;  // 99.9 %
  }
  EXPECT_LT(nees, 3.0 + 3.0 * std::sqrt(6.0 / kRuns));
  EXPECT_GT(nees, 1.5 - 3.0 * std::sqrt(6.0 / kRuns));
  EXPECT_LE(outside, 3);
}

TEST(ScanMatching, ACorridorLeavesTheWayAlongToTheOdometry) {
  std::mt19937_64 random(3);
  ScanMatcher matcher(without_floor());
  for (int i = 0; i < 20; ++i) {
    const Vector3d T(0.2, 0.0, 0.0), guess(0.17, 0.03, 0.02);
    const auto found = match(matcher, scan_at(kCorridor, {0, 0, 0}, 0.01, random),
                             scan_at(kCorridor, T, 0.01, random), guess);
    ASSERT_TRUE(found);
    const Eigen::Matrix3d& L = found->information;
    EXPECT_LT(L(0, 0), 1e-2 * L(1, 1));
    // The product with a guess that knows 1 cm along: it stays there, and is corrected elsewhere.
    const Eigen::Matrix3d guessed = Vector3d(1e4, 100.0, 100.0).asDiagonal();
    const Vector3d fused = guess + (L + guessed).inverse() * found->pull;
    EXPECT_NEAR(fused[0], guess[0], 0.01);
    EXPECT_NEAR(fused[1], 0.0, 0.01);
    EXPECT_NEAR(fused[2], 0.0, 0.005);
  }
}

TEST(ScanMatching, TheFloorBoundsWhatAMatchClaims) {
  std::mt19937_64 none(1);
  ScanMatcher matcher({});
  const auto found = match(matcher, scan_at(kRoom, {0, 0, 0}, 0.0, none),
                           scan_at(kRoom, {0.1, 0, 0}, 0.0, none), {0.1, 0, 0});
  ASSERT_TRUE(found);
  const Eigen::Matrix3d cov = found->information.inverse();
  const ScanMatchingParameters defaults;
  EXPECT_GT(std::sqrt(cov(0, 0)), defaults.floor_xy);
  EXPECT_GT(std::sqrt(cov(2, 2)), defaults.floor_heading_deg * kPi / 180.0);
}

TEST(ScanMatching, ATurnThatTheOdometryMissedIsFound) {
  std::mt19937_64 random(5);
  ScanMatcher matcher({});
  const Vector3d T(0.1, 0.0, 0.5);
  const auto found = match(matcher, scan_at(kRoom, {0, 0, 0}, 0.01, random),
                           scan_at(kRoom, T, 0.01, random), {0.1, 0.0, 0.0});
  ASSERT_TRUE(found);
  EXPECT_NEAR((found->information.inverse() * found->pull)[2], 0.5, 0.02);
}

TEST(ScanMatching, DifferentPlacesDoNotMatch) {
  std::mt19937_64 random(5);
  ScanMatcher matcher({});
  const std::vector<Wall> elsewhere = {{{20, -9}, {20, 30}}, {{-9, 25}, {20, 25}}};
  EXPECT_FALSE(match(matcher, scan_at(kRoom, {0, 0, 0}, 0.01, random),
                     scan_at(elsewhere, {0, 0, 0}, 0.01, random), {0, 0, 0}));
}

TEST(ScanMatching, ScansWithoutPointsAreRefused) {
  std::mt19937_64 random(5);
  ScanMatcher matcher({});
  Scan empty;
  EXPECT_FALSE(matcher.look(empty));
  Scan broken = scan_at(kRoom, {0, 0, 0}, 0.01, random);
  for (std::size_t i = 0; i < broken.getScanSize(); ++i)
    broken.setScanRange(i, i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : -1.0F);
  EXPECT_FALSE(matcher.look(broken));
  EXPECT_FALSE(matcher.match({0, 0, 0}, kVague));  // there is nothing to match
  const Scan good = scan_at(kRoom, {0, 0, 0}, 0.01, random);
  ASSERT_TRUE(matcher.look(good));
  matcher.renew_reference();
  EXPECT_FALSE(matcher.look(broken));
  EXPECT_FALSE(matcher.match({0, 0, 0}, kVague));
}

TEST(ScanMatching, TheSameScansGiveTheSameBytes) {
  std::mt19937_64 random(9);
  const Scan a = scan_at(kRoom, {0, 0, 0}, 0.02, random);
  const Scan b = scan_at(kRoom, {0.1, 0.02, 0.1}, 0.02, random);
  ScanMatcher fresh({}), used({});
  (void)match(used, b, a, {0, 0, 0});
  const auto first = match(fresh, a, b, {0.08, 0, 0.1}), second = match(used, a, b, {0.08, 0, 0.1});
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->information, second->information);
  EXPECT_EQ(first->pull, second->pull);
}

}  // namespace
}  // namespace libslam
