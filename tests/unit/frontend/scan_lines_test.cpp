#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <libslam/frontend/scan_lines.hpp>

namespace libslam {
namespace {

using Scan = mrpt::obs::CObservation2DRangeScan;

/// A wall to the left of a scanner that looks forward: 1.5 m away, seen by 181 beams.
Scan::Ptr wall_on_the_left(bool counterclockwise = true) {
  auto scan = Scan::Create();
  scan->sensorLabel = "laser";
  scan->aperture = static_cast<float>(kPi);
  scan->rightToLeft = counterclockwise;
  scan->maxRange = 20.0F;
  scan->resizeScan(181);
  for (std::size_t i = 0; i < 181; ++i) {
    const double bearing = (static_cast<double>(i) - 90.0) * kPi / 180.0;
    const double range = bearing > 0.2 ? 1.5 / std::sin(bearing) : 30.0;
    const std::size_t beam = counterclockwise ? i : 180 - i;
    scan->setScanRange(beam, static_cast<float>(range));
    scan->setScanRangeValidity(beam, range < 20.0);
  }
  return scan;
}

std::vector<FeatureBatch> extract(ScanLines& frontend, const Scan::Ptr& scan) {
  mrpt::obs::CSensoryFrame frame;
  frame.insert(scan);
  std::vector<FeatureBatch> batches;
  frontend.extract(frame, batches);
  return batches;
}

TEST(ScanLines, AWallIsALineInTheFrameOfTheSensor) {
  for (const bool counterclockwise : {true, false}) {
    ScanLines frontend({}, "");
    auto scan = wall_on_the_left(counterclockwise);
    scan->sensorPose = mrpt::poses::CPose3D(0.2, -0.1, 0.5, 0.3, 0.0, 0.0);
    const auto batches = extract(frontend, scan);
    ASSERT_EQ(batches.size(), 1u);
    ASSERT_EQ(batches[0].size(), 1u);
    const Feature& wall = batches[0][0];
    EXPECT_NEAR(wall.z[0], kPi / 2, 1e-4);  // ranges are floats
    EXPECT_NEAR(wall.z[1], 1.5, 1e-4);
    EXPECT_LT((wall.T_robot_sensor - Eigen::Vector3d(0.2, -0.1, 0.3)).norm(), 1e-12);
    ASSERT_TRUE(wall.extent);
    EXPECT_NEAR(wall.extent->begin, -1.5 / std::tan(12.0 * kPi / 180.0), 1e-3);
    EXPECT_NEAR(wall.extent->end, 0.0, 1e-3);  // straight left: 90 deg is the last beam
    EXPECT_EQ(wall.id, kNoIdentity);
  }
}

TEST(ScanLines, AScannerOnItsHeadSeesTheWallOnTheOtherSide) {
  ScanLines frontend({}, "");
  auto scan = wall_on_the_left();
  scan->sensorPose = mrpt::poses::CPose3D(0.0, 0.0, 0.5, 0.0, 0.0, kPi);
  const auto batches = extract(frontend, scan);
  ASSERT_EQ(batches[0].size(), 1u);
  EXPECT_NEAR(batches[0][0].z[0], -kPi / 2, 1e-4);
}

TEST(ScanLines, ATiltedScannerIsLeftOutWithAWarning) {
  ScanLines frontend({}, "");
  auto scan = wall_on_the_left();
  scan->sensorPose = mrpt::poses::CPose3D(0.0, 0.0, 0.5, 0.0, 0.3, 0.0);
  EXPECT_TRUE(extract(frontend, scan).empty());
  EXPECT_EQ(frontend.unusable(), 1);
  ASSERT_EQ(frontend.warnings().size(), 1u);
  EXPECT_NE(frontend.warnings()[0].find("laser"), std::string::npos);
}

TEST(ScanLines, BeamsThatAreNoNumbersAreCountedAndOthersUsed) {
  ScanLines frontend({}, "");
  auto scan = wall_on_the_left();
  for (const std::size_t beam : {120u, 130u})
    scan->setScanRange(beam, std::numeric_limits<float>::quiet_NaN());
  scan->setScanRange(140, -1.0F);
  EXPECT_EQ(extract(frontend, scan)[0].size(), 1u);
  EXPECT_EQ(frontend.unusable(), 3);
}

TEST(ScanLines, OtherSensorsAndRangesAreLeftOut) {
  ScanLines other({}, "rear");
  EXPECT_TRUE(extract(other, wall_on_the_left()).empty());
  FrontendParameters near;
  near.max_range = 1.55;
  ScanLines frontend(near, "laser");
  const auto batches = extract(frontend, wall_on_the_left());
  ASSERT_EQ(batches.size(), 1u);  // a scan without lines is an observation nevertheless
  EXPECT_TRUE(batches[0].empty());
  EXPECT_EQ(frontend.figures().at("scans"), 1.0);
}

TEST(ScanLines, AScanWithoutBeamsIsHarmless) {
  ScanLines frontend({}, "");
  auto scan = wall_on_the_left();
  for (const std::size_t beams : {0u, 1u, 2u}) {
    scan->resizeScan(beams);
    EXPECT_TRUE(extract(frontend, scan)[0].empty());
  }
}

}  // namespace
}  // namespace libslam
