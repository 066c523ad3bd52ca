#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationStereoImagesFeatures.h>

#include <libslam/frontend/stereo_observation.hpp>

using namespace libslam;
using mrpt::obs::CObservationStereoImagesFeatures;

namespace {

CObservationStereoImagesFeatures::Ptr make_observation() {
  auto o = CObservationStereoImagesFeatures::Create();
  o->sensorLabel = "stereo";
  o->cameraLeft.setIntrinsicParamsFromValues(400.0, 410.0, 320.0, 240.0);
  o->cameraRight = o->cameraLeft;
  o->rightCameraPose.x(0.25);
  o->cameraPoseOnRobot =
      mrpt::poses::CPose3DQuat(mrpt::poses::CPose3D(0.1, 0.2, 0.3, -M_PI / 2, 0.0, -M_PI / 2));
  return o;
}

void add_point(CObservationStereoImagesFeatures& o, float ul, float vl, float ur, float vr,
               unsigned id) {
  o.theFeatures.push_back({{mrpt::img::TPixelCoordf(ul, vl), mrpt::img::TPixelCoordf(ur, vr)}, id});
}

struct Extraction {
  std::vector<FeatureBatch> batches;
  std::int64_t unusable = 0;
};

Extraction extract(const CObservationStereoImagesFeatures::Ptr& observation,
                   const StereoNoiseParameters& noise = {}, FrontendParameters frontend = {},
                   bool with_identities = true) {
  StereoObservation source(frontend, noise, "", with_identities);
  mrpt::obs::CSensoryFrame frame;
  frame.insert(observation);
  Extraction out;
  source.extract(frame, out.batches);
  out.unusable = source.unusable();
  return out;
}

}  // namespace

TEST(StereoObservation, PixelsBecomeColumnRowAndDisparity) {
  const auto o = make_observation();
  add_point(*o, 330, 250, 310, 252, 7);
  StereoNoiseParameters noise;
  noise.sigma_pixel = 2.0;
  noise.sigma_v_right = 1.0;
  noise.sigma_u_right = 3.0;
  const auto [batches, unusable] = extract(o, noise);
  ASSERT_EQ(batches.size(), 1U);
  const Feature& f = batches[0][0];
  EXPECT_EQ(f.id, 7);
  EXPECT_EQ(unusable, 0);
  // The right row has four times the weight of the left one.
  EXPECT_LT((f.z - Eigen::Vector3d(330.0, 0.2 * 250 + 0.8 * 252, 20.0)).norm(), 1e-12);
  const Eigen::Matrix3d expected{{4, 0, 4}, {0, 0.8, 0}, {4, 0, 4 + 9}};
  EXPECT_LT((f.cov - expected).norm(), 1e-12);
  EXPECT_EQ(f.camera->baseline, 0.25);
  EXPECT_EQ(f.camera->fy, 410.0);
  // Ahead of the camera is ahead of the robot.
  const Eigen::Vector3d ahead = f.camera->T_robot_camera * Eigen::Vector3d(0, 0, 2);
  EXPECT_LT((ahead - Eigen::Vector3d(2.1, 0.2, 0.3)).norm(), 1e-12);
}

TEST(StereoObservation, ConsecutiveObservationsShareTheirCamera) {
  StereoObservation source({}, {}, "", true);
  std::vector<FeatureBatch> first, second;
  for (auto* batches : {&first, &second}) {
    const auto o = make_observation();
    add_point(*o, 330, 250, 310, 250, 1);
    mrpt::obs::CSensoryFrame frame;
    frame.insert(o);
    source.extract(frame, *batches);
  }
  EXPECT_EQ(first[0][0].camera, second[0][0].camera);
}

TEST(StereoObservation, LeavesOutWhatHasNoDepthInRange) {
  const auto o = make_observation();
  for (const float d : {-5.0F, 0.0F, 5.0F, 20.0F, 200.0F}) add_point(*o, 330, 250, 330 - d, 250, 1);
  FrontendParameters frontend;
  frontend.min_range = 1.0;   // d <= 100
  frontend.max_range = 10.0;  // d >= 10
  const auto [batches, unusable] = extract(o, {}, frontend, false);
  ASSERT_EQ(batches.size(), 1U);
  ASSERT_EQ(batches[0].size(), 1U);
  EXPECT_EQ(batches[0][0].z[2], 20.0);
  EXPECT_EQ(batches[0][0].id, kNoIdentity);
  EXPECT_EQ(unusable, 0);
}

TEST(StereoObservation, CountsCoordinatesThatAreNoNumbers) {
  const auto o = make_observation();
  add_point(*o, std::numeric_limits<float>::quiet_NaN(), 250, 310, 250, 1);
  add_point(*o, 330, std::numeric_limits<float>::infinity(), 310, 250, 1);
  const auto [batches, unusable] = extract(o);
  EXPECT_TRUE(batches.empty());
  EXPECT_EQ(unusable, 2);
}

TEST(StereoObservation, CountsPointsOfPairsThatAreNotRectified) {
  const std::vector<std::function<void(CObservationStereoImagesFeatures&)>> defects = {
      [](auto& o) { o.cameraLeft.dist[0] = 0.1; },
      [](auto& o) { o.cameraRight.setIntrinsicParamsFromValues(401.0, 410.0, 320.0, 240.0); },
      [](auto& o) { o.rightCameraPose.x(-0.25); },
      [](auto& o) { o.rightCameraPose.y(0.01); },
      [](auto& o) {
        o.rightCameraPose =
            mrpt::poses::CPose3DQuat(mrpt::poses::CPose3D(0.25, 0, 0, 0.0, 0.01, 0.0));
      },
      [](auto& o) { o.rightCameraPose.x(std::nan("")); }};
  for (const auto& spoil : defects) {
    const auto o = make_observation();
    add_point(*o, 330, 250, 310, 250, 1);
    spoil(*o);
    const auto [batches, unusable] = extract(o);
    EXPECT_TRUE(batches.empty());
    EXPECT_EQ(unusable, 1);
  }
}
