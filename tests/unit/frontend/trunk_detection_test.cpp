// Circles in a scan: where they are, how sure that is, and what is none.

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <libslam/frontend/scan_trunks.hpp>

namespace libslam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDegree = kPi / 180.0;

struct Circle {
  double range, bearing, diameter;
};

/// Ranges of 361 beams over half a turn among circles, exact.
class Scene {
 public:
  std::vector<double> ranges = std::vector<double>(361, kInfinity);
  double first_bearing = -0.5 * kPi, resolution = 0.5 * kDegree;

  BeamView view() const { return {ranges, first_bearing, resolution}; }
  double bearing(std::size_t i) const {
    return first_bearing + resolution * static_cast<double>(i);
  }

  Scene& add(const Circle& circle) {
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const double beside = bearing(i) - circle.bearing;
      const double across = circle.range * std::sin(beside), radius = 0.5 * circle.diameter;
      if (std::abs(beside) > 1.0 || std::abs(across) > radius) continue;
      ranges[i] = std::min(ranges[i], circle.range * std::cos(beside) -
                                          std::sqrt(radius * radius - across * across));
    }
    return *this;
  }
  Scene& add_wall(double distance) {
    for (std::size_t i = 0; i < ranges.size(); ++i)
      if (std::cos(bearing(i)) > 0.05)
        ranges[i] = std::min(ranges[i], distance / std::cos(bearing(i)));
    return *this;
  }
};

std::vector<DetectedTrunk> detect(const Scene& scene, const TrunkParameters& parameters = {}) {
  std::vector<DetectedTrunk> trunks;
  TrunkDetector(parameters).detect(scene.view(), trunks);
  return trunks;
}

TrunkParameters exact_parameters() {
  TrunkParameters p;
  p.min_beams = 1;
  p.sigma_range = 1e-4;
  p.sigma_centre = 0.0;
  p.skew = 100.0;  // a grazing beam is much deeper than the other edge
  return p;
}

TEST(TrunkDetection, CentreAndDiameterWithinWhatTheBeamsResolve) {
  Scene scene;
  scene.add({5.0, -0.6, 0.4}).add({12.0, 0.1, 0.6}).add({3.0, 0.9, 0.3});
  const auto trunks = detect(scene);
  ASSERT_EQ(trunks.size(), 3u);
  const Circle truth[] = {{5.0, -0.6, 0.4}, {12.0, 0.1, 0.6}, {3.0, 0.9, 0.3}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(trunks[i].bearing, truth[i].bearing, 0.5 * scene.resolution);
    EXPECT_NEAR(trunks[i].diameter, truth[i].diameter, 1.01 * scene.resolution * truth[i].range);
    EXPECT_NEAR(trunks[i].range, truth[i].range, 0.7 * scene.resolution * truth[i].range);
  }
}

TEST(TrunkDetection, AKnownDiameterLeavesTheRangeExact) {
  TrunkParameters p = exact_parameters();
  p.known_diameter = 0.4;
  // The edges lie symmetrically to the beams: the bearing is exact and so is every beam's distance.
  Scene scene;
  scene.add({5.0, 10.0 * kDegree, 0.4});
  const auto trunks = detect(scene, p);
  ASSERT_EQ(trunks.size(), 1u);
  EXPECT_NEAR(trunks[0].bearing, 10.0 * kDegree, 1e-12);
  EXPECT_NEAR(trunks[0].range, 5.0, 1e-9);
}

// Errors over random places and sizes, normalized by what the detection claims: mean square 1. The
// standard error over 4000 circles is 2 % for uniform errors, up to 4 % for the heavier tails of a
// radius that enters twice.
TEST(TrunkDetection, ClaimedVarianceIsThatOfTheErrors) {
  std::mt19937 generator(42);
  std::uniform_real_distribution<double> range(5.0, 30.0), bearing(-1.2, 1.2), diameter(0.3, 0.9);
  double along = 0.0, across = 0.0, drift = 0.0;
  int count = 0;
  for (int k = 0; k < 4000; ++k) {
    const Circle circle{range(generator), bearing(generator), diameter(generator)};
    Scene scene;
    const auto trunks = detect(scene.add(circle), exact_parameters());
    if (trunks.size() != 1) continue;  // thicker than a metre by the beams, or between two beams
    const double d = trunks[0].range - circle.range, b = trunks[0].bearing - circle.bearing;
    along += d * d / trunks[0].cov(0, 0);
    across += b * b / trunks[0].cov(1, 1);
    drift += d / std::sqrt(trunks[0].cov(0, 0));
    ++count;
  }
  EXPECT_GT(count, 3800);
  EXPECT_NEAR(across / count, 1.0, 0.08);
  EXPECT_NEAR(along / count, 1.0, 0.25);
  EXPECT_NEAR(drift / count, 0.0, 0.15);
}

TEST(TrunkDetection, NoiseOfTheBeamsIsPartOfTheVariance) {
  std::mt19937 generator(7);
  std::normal_distribution<double> noise(0.0, 0.05);
  TrunkParameters p = exact_parameters();
  p.known_diameter = 0.4;
  p.sigma_range = 0.05;
  double square = 0.0;
  constexpr int kScans = 2000;
  for (int k = 0; k < kScans; ++k) {
    Scene scene;
    scene.add({5.0, 10.0 * kDegree, 0.4});
    for (double& r : scene.ranges) r += noise(generator);
    const auto trunks = detect(scene, p);
    ASSERT_EQ(trunks.size(), 1u);
    square += std::pow(trunks[0].range - 5.0, 2) / trunks[0].cov(0, 0);
  }
  EXPECT_NEAR(square / kScans, 1.0, 0.13);  // four standard errors of a chi-square with 2000 dof
}

TEST(TrunkDetection, HiddenEdgesAreRefused) {
  TrunkParameters p;
  p.isolation = 1.0;
  Scene in_front;
  in_front.add({4.0, 0.0, 0.3}).add({10.0, 0.05, 0.8});  // the far one loses its right edge
  const auto trunks = detect(in_front, p);
  ASSERT_EQ(trunks.size(), 1u);
  EXPECT_NEAR(trunks[0].range, 4.0, 0.1);
}

TEST(TrunkDetection, ATrunkBeforeAWallStandsFreeAndTheWallIsNone) {
  Scene scene;
  const auto trunks = detect(scene.add_wall(10.0).add({6.0, 0.2, 0.4}));
  ASSERT_EQ(trunks.size(), 1u);
  EXPECT_NEAR(trunks[0].range, 6.0, 0.1);
  EXPECT_TRUE(detect(Scene().add_wall(10.0)).empty());
  // Closer to the wall than a jump it is a part of the wall.
  EXPECT_TRUE(detect(Scene().add_wall(6.5).add({6.0, 0.0, 0.4})).empty());
}

TEST(TrunkDetection, BoundsOfSizeBeamsAndMargin) {
  const Circle circle{8.0, 0.3, 0.5};
  TrunkParameters p;
  EXPECT_EQ(detect(Scene().add(circle), p).size(), 1u);
  p.min_diameter = 0.6;
  EXPECT_TRUE(detect(Scene().add(circle), p).empty());
  p.min_diameter = 0.0;
  p.max_diameter = 0.4;
  EXPECT_TRUE(detect(Scene().add(circle), p).empty());
  p.max_diameter = 1.0;
  p.min_beams = 9;
  EXPECT_TRUE(detect(Scene().add(circle), p).empty());
  const Circle at_the_end{8.0, 88.0 * kDegree, 0.2};
  p = {};
  EXPECT_TRUE(detect(Scene().add(at_the_end), p).empty());
  p.margin_deg = 0.5;
  EXPECT_EQ(detect(Scene().add(at_the_end), p).size(), 1u);
}

TEST(TrunkDetection, ObjectsWithEdgesAtDifferentRangesAreNoTrunks) {
  Scene scene;
  for (std::size_t i = 0; i < 8; ++i) scene.ranges[200 + i] = 6.0 + 0.05 * static_cast<double>(i);
  TrunkParameters p;
  EXPECT_TRUE(detect(scene, p).empty());
  p.skew = 1.0;
  EXPECT_EQ(detect(scene, p).size(), 1u);
}

TEST(TrunkDetection, MissingBeamsWithinAnObjectDoNotSplitIt) {
  Scene holed;
  holed.add({6.0, 0.1, 0.6});
  const auto whole = detect(holed);
  ASSERT_EQ(whole.size(), 1u);
  holed.ranges[whole[0].first_beam + 3] = kInfinity;
  const auto trunks = detect(holed);
  ASSERT_EQ(trunks.size(), 1u);
  EXPECT_EQ(trunks[0].beams, whole[0].beams);
  EXPECT_NEAR(trunks[0].range, whole[0].range, 0.01);
  // A loose fence: every third beam hits it at 12 m.
  Scene fence;
  for (std::size_t i = 100; i < 250; i += 3) fence.ranges[i] = 12.0;
  EXPECT_TRUE(detect(fence).empty());
  TrunkParameters p;
  p.gap_deg = 0.0;
  p.isolation = 0.0;
  p.min_beams = 1;
  EXPECT_EQ(detect(fence, p).size(), 50u);
}

TEST(TrunkDetection, ATrunkStandsApartFromOthers) {
  Scene pair;
  pair.add({8.0, 0.0, 0.3}).add({10.0, 0.1, 0.3});  // 2.2 m apart
  EXPECT_TRUE(detect(pair).empty());
  TrunkParameters p;
  p.isolation = 1.5;
  EXPECT_EQ(detect(pair, p).size(), 2u);
}

TEST(TrunkDetection, RefusesNonsense) {
  TrunkParameters p;
  p.min_diameter = 2.0;
  EXPECT_THROW(TrunkDetector{p}, std::invalid_argument);
  p = {};
  p.jump = 0.0;
  EXPECT_THROW(TrunkDetector{p}, std::invalid_argument);
}

mrpt::obs::CObservation2DRangeScan to_scan(const Scene& scene, bool right_to_left) {
  mrpt::obs::CObservation2DRangeScan scan;
  scan.sensorLabel = "laser";
  scan.aperture = static_cast<float>(kPi);
  scan.rightToLeft = right_to_left;
  scan.sensorPose = mrpt::poses::CPose3D(1.5, 0.5, 0.0, 0.1, 0.0, 0.0);
  const std::size_t n = scene.ranges.size();
  scan.resizeScan(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t at = right_to_left ? i : n - 1 - i;
    const bool hit = std::isfinite(scene.ranges[i]);
    scan.setScanRange(at, hit ? static_cast<float>(scene.ranges[i]) : 0.0F);
    scan.setScanRangeValidity(at, hit);
  }
  return scan;
}

std::vector<FeatureBatch> extract(ScanTrunks& frontend,
                                  const mrpt::obs::CObservation2DRangeScan& scan) {
  mrpt::obs::CSensoryFrame frame;
  frame.insert(std::make_shared<mrpt::obs::CObservation2DRangeScan>(scan));
  std::vector<FeatureBatch> batches;
  frontend.extract(frame, batches);
  return batches;
}

TEST(ScanTrunks, FeaturesOfBothDirectionsOfScanning) {
  Scene scene;
  scene.add({5.0, -0.6, 0.4}).add({12.0, 0.3, 0.6});
  MeasurementParameters measurement;
  for (const bool right_to_left : {true, false}) {
    ScanTrunks frontend({}, measurement, "");
    const auto batches = extract(frontend, to_scan(scene, right_to_left));
    ASSERT_EQ(batches.size(), 1u);
    ASSERT_EQ(batches[0].size(), 2u);
    EXPECT_NEAR(batches[0][0].z[1], -0.6, 0.005);
    EXPECT_NEAR(batches[0][1].z[1], 0.3, 0.005);
    EXPECT_EQ(batches[0][0].id, kNoIdentity);
    EXPECT_TRUE(batches[0][0].T_robot_sensor.isApprox(Eigen::Vector3d(1.5, 0.5, 0.1), 1e-12));
    EXPECT_EQ(frontend.figures().at("trunks_per_scan"), 2.0);
  }
}

TEST(ScanTrunks, BiasOfTheLaserIsTakenOffItsRanges) {
  Scene scene;
  scene.add({5.0, 0.2, 0.4});
  FrontendParameters parameters;
  parameters.trunks.known_diameter = 0.4;
  ScanTrunks known(parameters, {}, "");
  parameters.trunks.range_bias = -0.1;
  ScanTrunks biased(parameters, {}, "");
  const auto scan = to_scan(scene, true);
  // The centre moves by the bias times the cosine of the beams beside it.
  EXPECT_NEAR(extract(biased, scan)[0][0].z[0] - extract(known, scan)[0][0].z[0], 0.1, 2e-3);
}

TEST(ScanTrunks, RangeLimitsLabelsNoiseAndUselessScans) {
  Scene scene;
  scene.add({5.0, -0.6, 0.4}).add({12.0, 0.3, 0.6});
  FrontendParameters parameters;
  parameters.max_range = 10.0;
  MeasurementParameters measurement;
  measurement.noise = "configured";
  measurement.sigma_range = 0.7;
  ScanTrunks frontend(parameters, measurement, "laser");
  const auto batches = extract(frontend, to_scan(scene, true));
  ASSERT_EQ(batches.size(), 1u);
  ASSERT_EQ(batches[0].size(), 1u);
  EXPECT_NEAR(batches[0][0].cov(0, 0), 0.49, 1e-12);
  auto other = to_scan(scene, true);
  other.sensorLabel = "rear";
  EXPECT_TRUE(extract(frontend, other).empty());
  auto flat = to_scan(scene, true);
  flat.aperture = 0.0F;
  EXPECT_TRUE(extract(frontend, flat).empty());
  EXPECT_EQ(frontend.unusable(), 1);
  auto garbage = to_scan(scene, true);
  for (std::size_t i = 0; i < garbage.getScanSize(); ++i) {
    garbage.setScanRange(i, std::numeric_limits<float>::quiet_NaN());
    garbage.setScanRangeValidity(i, true);
  }
  EXPECT_TRUE(extract(frontend, garbage).empty());
}

}  // namespace
}  // namespace libslam
