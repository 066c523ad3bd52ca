#include <cmath>
#include <functional>

#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBeaconRanges.h>
#include <mrpt/obs/CObservationStereoImagesFeatures.h>

#include <libslam/state/planar_pose.hpp>

#include "drive_fixture.hpp"

namespace libslam {
namespace {

using namespace libslam::testing;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationBeaconRanges;
using mrpt::obs::CObservationBearingRange;
using mrpt::obs::CObservationStereoImagesFeatures;

/// Mean and mean square of standardized errors.
struct Moments {
  double sum = 0.0, squares = 0.0;
  int count = 0;

  void add(double standardized) {
    sum += standardized;
    squares += standardized * standardized;
    ++count;
  }
  /// Zero mean and unit variance within four of their standard deviations.
  void expect_standard_normal() const {
    ASSERT_GT(count, 200);
    EXPECT_NEAR(sum / count, 0.0, 4.0 / std::sqrt(count));
    EXPECT_NEAR(squares / count, 1.0, 4.0 * std::sqrt(2.0 / count));
  }
};

/// Landmark `id` of a generated world (ids from 1).
Eigen::VectorXd place_of(const Simulator& simulator, std::int64_t id) {
  return simulator.landmarks()[static_cast<std::size_t>(id - 1)].position;
}

void for_each_step(const Scenario& s, std::uint64_t seed,
                   const std::function<void(const Simulator&, const SimulatedStep&)>& visit) {
  const auto simulator = make_simulator(s, seed);
  while (const auto step = simulator->next()) visit(*simulator, *step);
}

TEST(RangeBearingSensor, SeesWhatIsInViewWithTheNoiseOfTheLog) {
  const Scenario s = small_scenario();
  Moments range, bearing;
  for_each_step(s, 1, [&](const Simulator& simulator, const SimulatedStep& step) {
    const auto seen = observation_of<CObservationBearingRange>(step);
    if (!seen) return;
    EXPECT_FLOAT_EQ(seen->sensor_std_range, 0.2F);
    std::size_t in_view = 0;
    for (const auto& landmark : simulator.landmarks()) {
      const Eigen::Vector2d z = true_sighting(step.T_world_robot, landmark.position);
      in_view += z[0] <= 30.0 && std::abs(z[1]) <= kPi / 2 ? 1 : 0;
    }
    EXPECT_EQ(seen->sensedData.size(), in_view);
    for (const auto& m : seen->sensedData) {
      const Eigen::Vector2d z =
          true_sighting(step.T_world_robot, place_of(simulator, m.landmarkID));
      range.add((m.range - z[0]) / 0.2);
      bearing.add(wrap_angle(m.yaw - z[1]) / (2.0 * kPi / 180.0));
    }
  });
  range.expect_standard_normal();
  bearing.expect_standard_normal();
}

TEST(RangeBearingSensor, WithoutIdentitiesAndBehindWalls) {
  Scenario s = differential_scenario();
  s.log.identities = false;
  s.world.generator = "rooms";
  s.range_bearing.sigma_range = 1e-6;
  s.range_bearing.sigma_bearing_deg = 1e-6;
  std::size_t sightings = 0;
  for_each_step(s, 1, [&](const Simulator& simulator, const SimulatedStep& step) {
    const auto seen = observation_of<CObservationBearingRange>(step);
    if (!seen) return;
    const RayCaster walls(simulator.world().walls, {});
    for (const auto& m : seen->sensedData) {
      ++sightings;
      EXPECT_EQ(m.landmarkID, -1);
      const double a = step.T_world_robot.z() + m.yaw;
      const Eigen::Vector2d to = step.T_world_robot.head<2>() +
                                 0.999 * m.range * Eigen::Vector2d(std::cos(a), std::sin(a));
      EXPECT_TRUE(walls.sees(step.T_world_robot.head<2>(), to));
    }
  });
  EXPECT_GT(sightings, 100U);
}

TEST(RangeBearingSensor, LogStatesThePoseOfTheSensorAndTheTruthDiffers) {
  Scenario s = small_scenario();
  s.range_bearing.pose = {1.0, 0.5, 30.0};
  s.range_bearing.sigma_range = s.range_bearing.sigma_bearing_deg = 1e-6;
  s.truth.sensor_x = 0.2;
  s.truth.sensor_heading_deg = 5.0;
  const Eigen::Vector3d actual(1.2, 0.5, 35.0 * kPi / 180.0);
  int count = 0;
  for_each_step(s, 1, [&](const Simulator& simulator, const SimulatedStep& step) {
    const auto seen = observation_of<CObservationBearingRange>(step);
    if (!seen) return;
    EXPECT_DOUBLE_EQ(seen->sensorLocationOnRobot.x(), 1.0);
    EXPECT_NEAR(seen->sensorLocationOnRobot.yaw(), kPi / 6, 1e-12);
    for (const auto& m : seen->sensedData) {
      const Eigen::Vector2d z = true_sighting(compose_poses(step.T_world_robot, actual),
                                              place_of(simulator, m.landmarkID));
      EXPECT_NEAR(m.range, z[0], 1e-4);
      EXPECT_NEAR(wrap_angle(m.yaw - z[1]), 0.0, 1e-6);
      ++count;
    }
  });
  EXPECT_GT(count, 100);
}

TEST(BeaconSensor, RangesInSpaceWithTheNoiseOfTheLog) {
  Scenario s = small_scenario();
  s.world.max_height = 5.0;
  s.beacons.enabled = true;
  s.beacons.antenna_height = 1.5;
  s.beacons.pose = {0.4, -0.2, 0.0};
  Moments range;
  for_each_step(s, 1, [&](const Simulator& simulator, const SimulatedStep& step) {
    const auto heard = observation_of<CObservationBeaconRanges>(step);
    if (!heard) return;
    const Eigen::Vector2d p = transform_point(step.T_world_robot, {0.4, -0.2});
    for (const auto& m : heard->sensedData) {
      const double distance =
          (place_of(simulator, m.beaconID) - Eigen::Vector3d(p.x(), p.y(), 1.5)).norm();
      EXPECT_LE(distance, s.beacons.max_range);
      range.add((m.sensedDistance - distance) / s.beacons.sigma_range);
    }
  });
  range.expect_standard_normal();
}

TEST(LaserSensor, MeetsWallsAndTrunksWithTheNoiseOfTheLog) {
  Scenario s = differential_scenario();
  s.world.generator = "rooms";
  s.world.trunk_radius = 0.03;
  s.laser.enabled = true;
  s.laser.beams = 181;
  s.laser.aperture_deg = 270.0;
  s.laser.pose = {0.1, 0.0, 90.0};
  Moments range;
  int trunk_beams = 0;
  for_each_step(s, 1, [&](const Simulator& simulator, const SimulatedStep& step) {
    const auto scan = observation_of<CObservation2DRangeScan>(step);
    if (!scan) return;
    ASSERT_EQ(scan->getScanSize(), 181U);
    std::vector<Trunk> trunks;
    for (const auto& landmark : simulator.landmarks())
      trunks.push_back({landmark.position.head<2>(), 0.03});
    const RayCaster walls(simulator.world().walls, {}), all(simulator.world().walls, trunks);
    const Eigen::Vector3d sensor = compose_poses(step.T_world_robot, {0.1, 0.0, kPi / 2});
    for (std::size_t i = 0; i < 181; ++i) {
      const double a = sensor.z() + (static_cast<double>(i) - 90.0) * 1.5 * kPi / 180.0;
      EXPECT_NEAR(scan->getScanAngle(i), wrap_angle(a - sensor.z()), 1e-5);
      const Eigen::Vector2d direction(std::cos(a), std::sin(a));
      const double distance = all.cast(sensor.head<2>(), direction, 30.0);
      trunk_beams += distance < walls.cast(sensor.head<2>(), direction, 30.0) ? 1 : 0;
      ASSERT_TRUE(scan->getScanRangeValidity(i)) << "in a closed house";
      range.add((scan->getScanRange(i) - distance) / s.laser.sigma_range);
    }
  });
  EXPECT_GT(trunk_beams, 20);
  range.expect_standard_normal();
}

TEST(LaserSensor, NothingInRangeIsInvalid) {
  Scenario s = small_scenario();
  s.laser.enabled = true;
  s.drive.max_duration_s = 1.0;
  for_each_step(s, 1, [&](const Simulator&, const SimulatedStep& step) {
    const auto scan = observation_of<CObservation2DRangeScan>(step);
    if (!scan) return;
    for (std::size_t i = 0; i < scan->getScanSize(); ++i)
      EXPECT_FALSE(scan->getScanRangeValidity(i));
  });
}

TEST(StereoSensor, PixelsOfTheCameraThatTheLogDescribes) {
  Scenario s = small_scenario();
  s.world.max_height = 3.0;
  s.world.landmarks = 400;
  s.stereo.enabled = true;
  s.stereo.pose = {0.5, 0.1, 10.0};
  Moments pixels[4];
  for_each_step(s, 1, [&](const Simulator& simulator, const SimulatedStep& step) {
    const auto seen = observation_of<CObservationStereoImagesFeatures>(step);
    if (!seen) return;
    const auto& camera = seen->cameraLeft;
    const Eigen::Vector3d& T = step.T_world_robot;
    const mrpt::poses::CPose3D left = mrpt::poses::CPose3D(T.x(), T.y(), 0, T.z(), 0, 0) +
                                      mrpt::poses::CPose3D(seen->cameraPoseOnRobot);
    const mrpt::poses::CPose3D right = left + mrpt::poses::CPose3D(seen->rightCameraPose);
    for (const auto& feature : seen->theFeatures) {
      const Eigen::VectorXd p = place_of(simulator, feature.ID);
      mrpt::math::TPoint3D l, r;
      left.inverseComposePoint({p.x(), p.y(), p.z()}, l);
      right.inverseComposePoint({p.x(), p.y(), p.z()}, r);
      const auto& [pl, pr] = feature.pixels;
      pixels[0].add((pl.x - camera.cx() - camera.fx() * l.x / l.z) / s.stereo.sigma_pixel);
      pixels[1].add((pl.y - camera.cy() - camera.fy() * l.y / l.z) / s.stereo.sigma_pixel);
      pixels[2].add((pr.x - camera.cx() - camera.fx() * r.x / r.z) / s.stereo.sigma_pixel);
      pixels[3].add((pr.y - camera.cy() - camera.fy() * r.y / r.z) / s.stereo.sigma_pixel);
      EXPECT_GT(l.z, 0.0);
      EXPECT_LE(l.z, s.stereo.max_range);
    }
  });
  for (const Moments& moments : pixels) moments.expect_standard_normal();
}

TEST(Sensors, SwitchingOneOnChangesNoDrawOfAnother) {
  Scenario s = small_scenario();
  const auto alone = drive(s, 5);
  s.beacons.enabled = s.laser.enabled = s.stereo.enabled = true;
  const auto together = drive(s, 5);
  ASSERT_EQ(alone.size(), together.size());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    ASSERT_EQ(alone[i].T_world_robot, together[i].T_world_robot);
    const auto a = observation_of<CObservationBearingRange>(alone[i]);
    if (!a) continue;
    const auto b = observation_of<CObservationBearingRange>(together[i]);
    ASSERT_EQ(a->sensedData.size(), b->sensedData.size());
    for (std::size_t k = 0; k < a->sensedData.size(); ++k)
      EXPECT_EQ(a->sensedData[k].range, b->sensedData[k].range);
  }
}

}  // namespace
}  // namespace libslam
