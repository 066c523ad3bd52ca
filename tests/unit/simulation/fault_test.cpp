#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <libslam/state/planar_pose.hpp>

#include "drive_fixture.hpp"

namespace libslam {
namespace {

using namespace libslam::testing;
using mrpt::obs::CObservationBearingRange;

constexpr std::uint64_t kSeeds = 5;

/// One sighting and what it should have been, in a world whose landmarks stand still.
struct Sighting {
  double elapsed, distance;      ///< [s], [m], true
  Eigen::Vector2d standardized;  ///< errors per nominal standard deviation
};

std::vector<Sighting> sightings(const Scenario& s) {
  std::vector<Sighting> all;
  const Eigen::Array2d sigma(s.range_bearing.sigma_range,
                             s.range_bearing.sigma_bearing_deg * kPi / 180.0);
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto simulator = make_simulator(s, seed);
    double start = -1.0;
    while (const auto step = simulator->next()) {
      if (start < 0.0) start = step->step.time;
      const auto seen = observation_of<CObservationBearingRange>(*step);
      if (!seen) continue;
      for (const auto& m : seen->sensedData) {
        const auto& place = simulator->landmarks()[static_cast<std::size_t>(m.landmarkID - 1)];
        const Eigen::Vector2d z = true_sighting(step->T_world_robot, place.position);
        const Eigen::Array2d error(m.range - z[0], wrap_angle(m.yaw - z[1]));
        all.push_back({step->step.time - start, z[0], error / sigma});
      }
    }
  }
  return all;
}

/// Mean square of the range errors of those sightings that `picked` accepts, with its four-sigma
/// bound for normal errors of variance `expected`.
template <class Picked>
void expect_variance(const std::vector<Sighting>& all, double expected, Picked picked) {
  double sum = 0.0, expected_sum = 0.0, spread = 0.0;
  int count = 0;
  for (const Sighting& sighting : all) {
    if (!picked(sighting)) continue;
    sum += sighting.standardized.squaredNorm();
    expected_sum += 2.0 * expected;
    spread += 2.0 * 2.0 * expected * expected;
    ++count;
  }
  ASSERT_GT(count, 300);
  EXPECT_NEAR(sum, expected_sum, 4.0 * std::sqrt(spread));
}

TEST(OutlierFault, ReplacesTheFractionAskedForAndNothingElse) {
  Scenario s = small_scenario();
  const auto clean = sightings(s);
  s.faults.outliers = {true, 0.1};
  const auto faulty = sightings(s);
  ASSERT_EQ(clean.size(), faulty.size());
  std::size_t replaced = 0;
  for (std::size_t i = 0; i < clean.size(); ++i)
    replaced += clean[i].standardized != faulty[i].standardized ? 1 : 0;
  const double n = static_cast<double>(clean.size());
  EXPECT_NEAR(static_cast<double>(replaced) / n, 0.1, 4.0 * std::sqrt(0.1 * 0.9 / n));
}

TEST(OutlierFault, LaserBeamsToo) {
  Scenario s = small_scenario();
  s.laser.enabled = true;  // nothing in view: every valid beam is an outlier
  s.faults.outliers = {true, 0.02};
  double valid = 0, beams = 0;
  for (const auto& step : drive(s, 1)) {
    const auto scan = observation_of<mrpt::obs::CObservation2DRangeScan>(step);
    if (!scan) continue;
    for (std::size_t i = 0; i < scan->getScanSize(); ++i) {
      valid += scan->getScanRangeValidity(i) ? 1 : 0;
      ++beams;
    }
  }
  EXPECT_NEAR(valid / beams, 0.02, 4.0 * std::sqrt(0.02 * 0.98 / beams));
}

TEST(NoiseStepFault, MultipliesTheNoiseBetweenItsTimesAlone) {
  Scenario s = small_scenario();
  s.faults.noise_step = {true, 5.0, 12.0, 3.0};
  const auto all = sightings(s);
  // Times of the log are rounded to 2.4e-7 s, so the borders are left out.
  expect_variance(all, 9.0, [](auto& z) { return z.elapsed > 5.1 && z.elapsed < 11.9; });
  expect_variance(all, 1.0, [](auto& z) { return z.elapsed < 4.9 || z.elapsed > 12.1; });
}

TEST(DistanceNoiseFault, GrowsWithTheDistance) {
  Scenario s = small_scenario();
  s.faults.distance_noise = {true, 0.1};
  double sum = 0.0;
  const auto all = sightings(s);
  for (const Sighting& z : all) sum += (z.standardized / (1.0 + 0.1 * z.distance)).squaredNorm();
  const double n = 2.0 * static_cast<double>(all.size());
  EXPECT_NEAR(sum / n, 1.0, 4.0 * std::sqrt(2.0 / n));
}

Scenario silent_scenario() {
  Scenario s = small_scenario();
  s.motion.noise.along_per_sqrt_s = s.motion.noise.steering_per_sqrt_s = 0.0;
  s.drive.max_duration_s = 60.0;
  return s;
}

/// True increment of each step against what the log says.
template <class Visit>
void for_each_motion(const Scenario& s, std::uint64_t seed, Visit visit) {
  const auto steps = drive(s, seed);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const auto motion = steps[i].step.action->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
    const mrpt::poses::CPose2D mean = motion->poseChange->getMeanVal();
    visit(relative_pose(steps[i - 1].T_world_robot, steps[i].T_world_robot),
          Eigen::Vector3d(mean.x(), mean.y(), mean.phi()));
  }
}

TEST(SlipFault, HasItsRateLengthAndEffect) {
  Scenario s = silent_scenario();
  s.faults.slip = {true, 0.2, 0.5, 0.4, 10.0};
  double slipping = 0, starts = 0, gripping = 0;
  for (std::uint64_t seed = 1; seed <= 2 * kSeeds; ++seed) {
    bool before = false;
    for_each_motion(s, seed, [&](const Eigen::Vector3d& truth, const Eigen::Vector3d& logged) {
      const double ratio = truth.head<2>().norm() / logged.head<2>().norm();
      const bool slips = ratio < 0.99;
      if (slips) {
        EXPECT_NEAR(ratio, 0.4, 1e-9);
        EXPECT_NEAR(std::abs(truth.z() - logged.z()), 10.0 * kPi / 180.0 * 0.025, 1e-6);
      } else {
        EXPECT_NEAR((truth - logged).norm(), 0.0, 1e-9);
      }
      (slips ? slipping : gripping) += 0.025;
      starts += slips && !before ? 1 : 0;
      before = slips;
    });
  }
  // A Poisson count of mean rate * time with grip; slips that follow at once look like one.
  const double expected = 0.2 * gripping;
  EXPECT_NEAR(slipping / 0.5, expected, 4.0 * std::sqrt(expected));
  EXPECT_NEAR(starts, expected, 4.0 * std::sqrt(expected));
  EXPECT_GT(starts, 30);
}

TEST(KidnapFault, MovesTheRobotOnceAsAsked) {
  Scenario s = silent_scenario();
  s.faults.kidnap = {true, 10.0, 3.0, -1.0, 20.0};
  int kidnapped = 0, index = 0;
  for_each_motion(s, 1, [&](const Eigen::Vector3d& truth, const Eigen::Vector3d& logged) {
    ++index;
    const Eigen::Vector3d unseen = relative_pose(logged, truth);
    if (unseen.norm() < 1e-6) return;
    ++kidnapped;
    EXPECT_EQ(index, 400);  // 10 s of .025 s
    EXPECT_LT((unseen - Eigen::Vector3d(3.0, -1.0, 20.0 * kPi / 180.0)).norm(), 1e-9);
  });
  EXPECT_EQ(kidnapped, 1);
}

TEST(MovingLandmarkFault, MovesTheFractionOnLinesAtItsSpeed) {
  std::vector<TrueLandmark> landmarks;
  for (int i = 0; i < 2000; ++i) landmarks.push_back({i, Eigen::Vector2d(i, 0.0)});
  const LandmarkMotion motion({true, 0.3, 0.5, 4.0}, landmarks, 1);
  std::vector<Eigen::Vector3d> start, p;
  motion.place(0.0, start);
  motion.place(6.0, p);  // 3 m out
  int moving = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double distance = (p[i] - start[i]).norm();
    if (distance == 0.0) continue;
    ++moving;
    sum += (p[i] - start[i]) / distance;
    EXPECT_NEAR(distance, 3.0, 1e-12);
  }
  EXPECT_NEAR(moving / 2000.0, 0.3, 4.0 * std::sqrt(0.3 * 0.7 / 2000.0));
  // Directions are uniform: either coordinate has variance 1/2.
  EXPECT_LT(sum.cwiseAbs().maxCoeff(), 4.0 * std::sqrt(moving / 2.0));
  motion.place(10.0, p);  // 5 m driven, 4 m out and 1 m back
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double distance = (p[i] - start[i]).norm();
    EXPECT_TRUE(distance == 0.0 || std::abs(distance - 3.0) < 1e-9) << distance;
  }
}

TEST(MovingLandmarkFault, IsSeenByTheSensors) {
  Scenario s = silent_scenario();
  s.drive.max_duration_s = 20.0;
  s.range_bearing.sigma_range = s.range_bearing.sigma_bearing_deg = 1e-6;
  s.faults.moving_landmarks = {true, 1.0, 0.5, 100.0};
  int count = 0;
  for (const Sighting& z : sightings(s)) {
    if (z.elapsed < 1.0) continue;
    const double error = z.standardized.x() * 1e-6;
    EXPECT_LE(std::abs(error), 0.5 * z.elapsed + 1e-3);
    count += std::abs(error) > 1e-3 ? 1 : 0;
  }
  EXPECT_GT(count, 100);
}

TEST(Faults, LeaveTheNoiseOfMotionAlone) {
  Scenario s = small_scenario();
  const auto clean = drive(s, 9);
  s.faults.outliers.enabled = s.faults.noise_step.enabled = true;
  s.faults.distance_noise.enabled = s.faults.moving_landmarks.enabled = true;
  const auto faulty = drive(s, 9);
  ASSERT_EQ(clean.size(), faulty.size());
  for (std::size_t i = 0; i < clean.size(); ++i)
    ASSERT_EQ(clean[i].T_world_robot, faulty[i].T_world_robot);
}

}  // namespace
}  // namespace libslam
