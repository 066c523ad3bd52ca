#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/frontend/line_extraction.hpp>

namespace libslam {
namespace {

constexpr double kStep = kPi / 180.0;

BeamPoint point_at(double range, double bearing) {
  return {range, bearing, {range * std::cos(bearing), range * std::sin(bearing)}};
}

struct Wall {
  double alpha, r, begin, end;  // the part between two places along it
};

/// What a scanner at the origin sees of walls, the nearest on every beam; `noise` [m] on ranges.
std::vector<BeamPoint> scan_of(const std::vector<Wall>& walls, double noise = 0.0,
                               unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<BeamPoint> points;
  for (int i = -90; i <= 90; ++i) {
    const double bearing = i * kStep;
    double nearest = 1e9;
    for (const Wall& wall : walls) {
      const double facing = std::cos(bearing - wall.alpha);
      if (facing < 1e-3) continue;
      const double place = wall.r * std::tan(bearing - wall.alpha);
      if (place >= wall.begin && place <= wall.end) nearest = std::min(nearest, wall.r / facing);
    }
    if (nearest < 1e8) points.push_back(point_at(nearest + noise * normal(random), bearing));
  }
  return points;
}

ScanLinesParameters without_floor() {
  ScanLinesParameters parameters;
  parameters.floor_alpha_deg = parameters.floor_r = 0.0;
  return parameters;
}

TEST(LineExtraction, RecoversAWallExactlyWithTheNormalTowardsIt) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> direction(-1.5, 1.5), distance(0.5, 6.0);
  LineExtraction extraction(without_floor());
  for (int i = 0; i < 8; ++i) {
    const Wall wall{direction(random), distance(random), -1.2, 1.0};
    const auto points = scan_of({wall});
    const auto lines = extraction.extract(points, kStep);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NEAR(lines[0].alpha, wall.alpha, 1e-9);
    EXPECT_NEAR(lines[0].r, wall.r, 1e-9);
    EXPECT_GE(lines[0].extent.begin, wall.begin - 1e-9);
    EXPECT_LE(lines[0].extent.end, wall.end + 1e-9);
    EXPECT_GT(lines[0].extent.sigma_begin, 0.0);
  }
}

// The scatter of a sampled covariance is sqrt(2 / n); five of these are allowed, and 2 % for the
// weights, which are those of ranges and not of distances from the line.
TEST(LineExtraction, TheCovarianceIsThatOfTheNoiseOfTheBeams) {
  constexpr int kSamples = 2000;
  constexpr double kNoise = 0.01;
  ScanLinesParameters parameters = without_floor();
  parameters.sigma_range = kNoise;
  parameters.split_distance = 0.2;  // no sample loses points
  LineExtraction extraction(parameters);
  const Wall wall{0.4, 2.0, -0.5, 2.0};
  Eigen::Matrix2d sampled = Eigen::Matrix2d::Zero(), predicted = sampled;
  for (int i = 0; i < kSamples; ++i) {
    const auto points = scan_of({wall}, kNoise, static_cast<unsigned>(i));
    const auto lines = extraction.extract(points, kStep);
    ASSERT_EQ(lines.size(), 1u);
    const Eigen::Vector2d e(lines[0].alpha - wall.alpha, lines[0].r - wall.r);
    sampled += e * e.transpose() / kSamples;
    predicted += lines[0].cov / kSamples;
  }
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 2; ++k)
      EXPECT_NEAR(
          sampled(i, k), predicted(i, k),
          (5.0 * std::sqrt(2.0 / kSamples) + 0.02) * std::sqrt(predicted(i, i) * predicted(k, k)));
}

TEST(LineExtraction, TheFloorStandsAtTheCentreAndIsWiderForShortLines) {
  ScanLinesParameters parameters;
  parameters.sigma_range = 1e-6;
  const double floor = parameters.floor_alpha_deg * kPi / 180.0;
  LineExtraction extraction(parameters);
  for (const double length : {1.0, 2.0, 4.0}) {
    const auto points = scan_of({{0.0, 3.0, 1.0, 1.0 + length}});
    const auto lines = extraction.extract(points, kStep);
    ASSERT_EQ(lines.size(), 1u);
    const double seen = lines[0].extent.length();
    EXPECT_NEAR(lines[0].cov(0, 0), floor * floor * (1.0 + 1.0 / (seen * seen)), 1e-9);
    // The variance of r n'c at the centre c of the points alone is that of the floor.
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    for (const BeamPoint& point : points) centre += point.p / static_cast<double>(points.size());
    const Eigen::RowVector2d to_centre(-centre.y(), 1.0);
    EXPECT_NEAR((to_centre * lines[0].cov * to_centre.transpose())(0),
                parameters.floor_r * parameters.floor_r, 1e-9);
  }
}

TEST(LineExtraction, SplitsCornersAndPutsTheLongestFirst) {
  LineExtraction extraction({});
  const auto points =
      scan_of({{0.0, 3.0, -2.0, 1.0}, {kPi / 2, 1.0, -3.0, 0.0}, {-kPi / 2, 2.0, 0.0, 3.0}});
  const auto lines = extraction.extract(points, kStep);
  ASSERT_EQ(lines.size(), 3u);
  std::vector<double> normals;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    normals.push_back(lines[i].alpha);
    if (i == 0) continue;
    EXPECT_GE(lines[i - 1].extent.length(), lines[i].extent.length());
  }
  std::ranges::sort(normals);
  EXPECT_NEAR(normals[0], -kPi / 2, 0.02);
  EXPECT_NEAR(normals[1], 0.0, 0.02);
  EXPECT_NEAR(normals[2], kPi / 2, 0.02);
}

TEST(LineExtraction, JoinsAWallAcrossADoorButNotAcrossAHall) {
  ScanLinesParameters parameters;
  LineExtraction extraction(parameters);
  const auto door = scan_of({{0.0, 2.0, -3.0, -0.4}, {0.0, 2.0, 0.4, 3.0}});
  ASSERT_EQ(extraction.extract(door, kStep).size(), 1u);
  EXPECT_GT(extraction.extract(door, kStep)[0].extent.length(), 5.0);
  const auto hall = scan_of({{0.0, 2.0, -3.0, -0.8}, {0.0, 2.0, 0.8, 3.0}});
  EXPECT_EQ(extraction.extract(hall, kStep).size(), 2u);
  // A step in the wall of more than the split distance is no door.
  const auto step = scan_of({{0.0, 2.0, -3.0, -0.4}, {0.0, 2.2, 0.4, 3.0}});
  EXPECT_EQ(extraction.extract(step, kStep).size(), 2u);
}

TEST(LineExtraction, LeavesOutWhatIsTooShortOrHasTooFewPoints) {
  ScanLinesParameters parameters;
  LineExtraction extraction(parameters);
  EXPECT_TRUE(extraction.extract(scan_of({{0.0, 2.0, -0.35, 0.35}}), kStep).empty());
  EXPECT_EQ(extraction.extract(scan_of({{0.0, 2.0, -0.5, 0.5}}), kStep).size(), 1u);
  EXPECT_TRUE(extraction.extract(scan_of({{0.0, 15.0, -0.5, 0.5}}), kStep).empty());  // 4 points
  EXPECT_TRUE(extraction.extract({}, kStep).empty());
}

/// Two walls that meet at a right angle at (3, -3), seen through noise of 3 cm.
ScanLinesParameters noisy() {
  ScanLinesParameters parameters = without_floor();
  parameters.sigma_range = 0.03;
  parameters.split_distance = 0.15;
  return parameters;
}

struct Biases {
  double alpha = 0.0, r = 0.0;  // mean errors in sigma of one scan
  double nees = 0.0;
};

/// Of the line with the normal nearest to `wall`, over many scans.
Biases biases_of(const Wall& wall, const std::vector<Wall>& walls, int scans) {
  LineExtraction extraction(noisy());
  Biases biases;
  for (int i = 0; i < scans; ++i) {
    const auto points = scan_of(walls, 0.03, static_cast<unsigned>(i));
    const ExtractedLine* nearest = nullptr;
    for (const ExtractedLine& line : extraction.extract(points, kStep))
      if (nearest == nullptr ||
          std::abs(line.alpha - wall.alpha) < std::abs(nearest->alpha - wall.alpha))
        nearest = &line;
    if (nearest == nullptr) continue;
    const Eigen::Vector2d error(nearest->alpha - wall.alpha, nearest->r - wall.r);
    biases.alpha += error[0] / std::sqrt(nearest->cov(0, 0)) / scans;
    biases.r += error[1] / std::sqrt(nearest->cov(1, 1)) / scans;
    biases.nees += error.dot(nearest->cov.llt().solve(error)) / scans;
  }
  return biases;
}

// Points of the other wall at the end of a run are off by less than noise may be, always to the
// same side. Means of 2000 scans scatter by 1 / sqrt(2000) sigma; without the cut at the corner
// they are half a sigma off.
TEST(LineExtraction, ACornerDoesNotBendItsWalls) {
  const std::vector<Wall> walls = {{0.0, 3.0, -3.0, 4.0}, {-0.5 * kPi, 3.0, -1.0, 3.0}};
  for (const Wall& wall : walls) {
    const Biases biases = biases_of(wall, walls, 2000);
    EXPECT_LT(std::abs(biases.alpha), 0.15);
    EXPECT_LT(std::abs(biases.r), 0.15);
    EXPECT_LT(biases.nees, 2.4);  // ideal 2
  }
}

// The farther end of a short segment: noise of the range moves a point off and along the wall.
TEST(LineExtraction, AShortWallFarToTheSideIsNotTilted) {
  const Wall wall{0.3, 2.0, 3.0, 4.5};
  const Biases biases = biases_of(wall, {wall}, 2000);
  EXPECT_LT(std::abs(biases.alpha), 0.1);
  EXPECT_LT(std::abs(biases.r), 0.1);
}

// A piece of wall that goes off to the side by less than split_distance, at grazing beams.
TEST(LineExtraction, GrazingBeamsTellALowStepFromNoise) {
  const std::vector<Wall> walls = {{-0.5 * kPi, 0.5, 0.0, 3.0}, {0.0, 3.0, -0.5, -0.25}};
  LineExtraction extraction(noisy());
  int wrong = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const auto points = scan_of(walls, 0.03, seed);
    for (const ExtractedLine& line : extraction.extract(points, 0.25 * kStep))
      wrong += std::abs(line.alpha + 0.5 * kPi) > 5.0 * std::sqrt(line.cov(0, 0));
  }
  EXPECT_LE(wrong, 2);
}

TEST(LineExtraction, PointsWithoutAWallAreNoLines) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> range(1.0, 10.0);
  std::vector<BeamPoint> points;
  for (int i = -90; i <= 90; ++i) points.push_back(point_at(range(random), i * kStep));
  LineExtraction extraction({});
  EXPECT_TRUE(extraction.extract(points, kStep).empty());
}

}  // namespace
}  // namespace libslam
