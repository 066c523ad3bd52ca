// A planar robot among landmarks with three coordinates: disturbed, but not searched for in the
// plane.

#include <memory>
#include <random>
#include <tests/support/disturbance_parts.hpp>
#include <tests/support/slam_world.hpp>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <libslam/filter/ekf_slam.hpp>
#include <libslam/measurement/stereo_point.hpp>

using namespace libslam;
using libslam::testing::disturbance_parts;
using libslam::testing::SlamWorld;

namespace {

std::shared_ptr<const StereoCamera> forward_camera() {
  auto camera = std::make_shared<StereoCamera>();
  camera->fx = camera->fy = 400.0;
  camera->cx = 320.0;
  camera->cy = 240.0;
  camera->baseline = 0.3;
  const Eigen::Matrix3d axes{{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}};
  camera->T_robot_camera = Eigen::Translation3d(0.2, 0.0, 0.8) * Eigen::Quaterniond(axes);
  return camera;
}

EkfSlamParts parts_with(bool relocalize, double slip_probability) {
  ResponseOptions response;
  response.relocalize = relocalize;
  response.slip_probability = slip_probability;
  return disturbance_parts(std::make_unique<StereoPoint>(3), 3, response);
}

/// What the camera sees of the landmarks of `world`, which stand at different heights.
std::vector<Feature> look(const SlamWorld& world, std::mt19937_64& random) {
  static const auto camera = forward_camera();
  std::normal_distribution<double> normal;
  const StereoPoint model(3);
  std::vector<Feature> features;
  for (std::size_t i = 0; i < world.landmarks.size(); ++i) {
    GaussianState state;
    const BlockId pose = state.add({"pose", Chart::kSE2, 3, WorldRole::kPose}, world.pose,
                                   Eigen::Matrix3d::Identity());
    const Eigen::Vector3d place(world.landmarks[i].x(), world.landmarks[i].y(),
                                0.4 * static_cast<double>(i % 5));
    const BlockId landmark = state.add(model.landmark_spec(), place, Eigen::Matrix3d::Identity());
    Feature feature;
    feature.id = static_cast<std::int64_t>(i);
    feature.camera = camera;
    feature.cov = 0.25 * Eigen::Matrix3d::Identity();
    feature.z = model.predict(state, pose, landmark, feature);
    const bool in_view =
        feature.z.allFinite() && feature.z[0] > 0.0 && feature.z[0] < 640.0 && feature.z[2] > 8.0;
    if (!in_view) continue;
    for (double& value : feature.z) value += 0.5 * normal(random);
    features.push_back(feature);
  }
  return features;
}

}  // namespace

TEST(SpatialDisturbance, APlanarRobotFindsBackAmongLandmarksInSpace) {
  for (const double slip_probability : {0.0, 0.001}) {
    std::mt19937_64 random(3);
    SlamWorld world;
    EkfSlam filter(parts_with(false, slip_probability));
    int disturbances = 0;
    const auto step = [&] {
      const MotionAction action = world.drive(random, 1.0);
      filter.propagate(&action);
      disturbances += filter.update(look(world, random)).event == "disturbance" ? 1 : 0;
    };
    for (int k = 0; k < 150; ++k) step();
    EXPECT_EQ(disturbances, 0);
    world.pose.head<2>() += Eigen::Vector2d(0.6, -0.5);
    for (int k = 0; k < 15; ++k) step();
    EXPECT_GE(disturbances, 1);
    const Eigen::Vector3d error = filter.state().estimate(filter.pose()) - world.pose;
    EXPECT_LT(error.head<2>().norm(), 0.2);
    EXPECT_TRUE(filter.healthy());
  }
}

TEST(SpatialDisturbance, ThePlanarSearchIsRefusedAmongLandmarksInSpace) {
  EXPECT_THROW(EkfSlam{parts_with(true, 0.0)}, std::invalid_argument);
  EXPECT_NO_THROW(EkfSlam{parts_with(false, 0.0)});
}
