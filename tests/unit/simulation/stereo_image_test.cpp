#include <cmath>
#include <map>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationStereoImages.h>

#include <libslam/data/tag_points.hpp>
#include <libslam/frontend/fiducials.hpp>
#include <libslam/simulation/tag_plate.hpp>

#include "drive_fixture.hpp"

namespace libslam {
namespace {

using namespace libslam::testing;
using mrpt::obs::CObservationStereoImages;

Scenario tagged_rooms() {
  Scenario s = differential_scenario();
  s.world.generator = "rooms";
  s.world.rooms_x = 2;
  s.world.rooms_y = 1;
  s.world.landmarks = 12;
  s.world.max_height = 2.0;
  s.world.door_width = 1.4;
  s.drive.speed = 0.5;
  s.drive.way_point_radius = 0.3;
  s.drive.control_period_s = 0.05;
  s.drive.max_duration_s = 12.0;
  s.range_bearing.enabled = false;
  s.stereo_images.enabled = true;
  s.stereo_images.pose = {0.2, -0.1, 15.0};
  return s;
}

Eigen::Isometry3d robot_pose(const Eigen::Vector3d& T) {
  return Eigen::Translation3d(T.x(), T.y(), 0.0) *
         Eigen::AngleAxisd(T.z(), Eigen::Vector3d::UnitZ());
}

TEST(StereoImageSensor, TagsAppearWhereTheTruthAndTheLogSay) {
  const Scenario s = tagged_rooms();
  FrontendParameters p;
  p.fiducials.points = "all";
  Fiducials frontend(p, "stereo_images");
  const auto simulator = make_simulator(s, 3);
  std::map<std::int64_t, Eigen::Vector3d> truth;
  for (const auto& landmark : simulator->landmarks()) truth[landmark.id] = landmark.position;
  for (const auto& corner : tag_corners(simulator->world(), s.stereo_images.tag_size))
    truth[corner.id] = corner.position;
  int points = 0, off = 0;
  while (const auto step = simulator->next()) {
    if (!step->step.frame) continue;
    std::vector<FeatureBatch> batches;
    frontend.extract(*step->step.frame, batches);
    for (const FeatureBatch& batch : batches)
      for (const Feature& feature : batch) {
        ASSERT_TRUE(truth.contains(feature.id)) << feature.id;
        const StereoCamera& c = *feature.camera;
        const Eigen::Isometry3d T = robot_pose(step->T_world_robot) * c.T_robot_camera;
        const Eigen::Vector3d q = T.inverse() * truth[feature.id];
        const Eigen::Vector3d expected(c.cx + c.fx * q.x() / q.z(), c.cy + c.fy * q.y() / q.z(),
                                       c.fx * c.baseline / q.z());
        off += (feature.z - expected).cwiseAbs().maxCoeff() > 1.0 ? 1 : 0;
        ++points;
      }
  }
  EXPECT_GT(points, 50);
  // Plates that cut each other spoil a corner now and then.
  EXPECT_LE(off, points / 20) << "of " << points;
}

TEST(StereoImageSensor, SameSeedSameImages) {
  Scenario s = tagged_rooms();
  s.drive.max_duration_s = 0.5;
  const auto first = drive(s, 7), again = drive(s, 7), other = drive(s, 8);
  const auto a = observation_of<CObservationStereoImages>(first.front());
  const auto b = observation_of<CObservationStereoImages>(again.front());
  const auto c = observation_of<CObservationStereoImages>(other.front());
  ASSERT_TRUE(a && b && c);
  ASSERT_EQ(a->imageLeft.getWidth(), 320U);
  ASSERT_EQ(a->imageRight.getHeight(), 240U);
  int different = 0;
  double sum = 0.0, squares = 0.0;
  for (unsigned y = 0; y < 240; ++y)
    for (unsigned x = 0; x < 320; ++x) {
      const int v = *a->imageRight.ptr<std::uint8_t>(x, y);
      EXPECT_EQ(v, *b->imageRight.ptr<std::uint8_t>(x, y));
      different += v != *c->imageRight.ptr<std::uint8_t>(x, y) ? 1 : 0;
      sum += v;
      squares += v * v;
    }
  EXPECT_GT(different, 1000);  // the noise of the gray values
  const double n = 320.0 * 240.0, mean = sum / n;
  EXPECT_GT(std::sqrt(squares / n - mean * mean), 20.0);  // a texture
}

TEST(StereoImageSensor, SwitchingItOnChangesNoOtherSensor) {
  Scenario s = tagged_rooms();
  s.drive.max_duration_s = 1.0;
  s.range_bearing.enabled = true;
  const auto with = drive(s, 5);
  s.stereo_images.enabled = false;
  const auto without = drive(s, 5);
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i)
    EXPECT_EQ(with[i].T_world_robot, without[i].T_world_robot);
}

TEST(StereoImageSensor, CamerasMustBeBelowTheCeiling) {
  Scenario s = tagged_rooms();
  EXPECT_TRUE(find_conflicts(s).empty());
  s.stereo_images.camera_height = s.stereo_images.wall_height;
  EXPECT_EQ(find_conflicts(s).size(), 1U);
}

}  // namespace
}  // namespace libslam
