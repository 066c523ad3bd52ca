// Rectification, and the motion of a camera from points.

#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include <libslam/frontend/stereo_motion.hpp>
#include <libslam/frontend/stereo_rectification.hpp>

#include "stereo_fixture.hpp"

namespace libslam {
namespace {

using namespace libslam::testing;

/// What a camera with distortion sees of the plane Z = `depth` of the left camera, which carries a
/// texture of `kFocal / depth` px per metre.
Gray view_of_plane(const Texture& texture, const mrpt::img::TCamera& camera,
                   const Eigen::Isometry3d& T_left_camera, double depth) {
  cv::Mat K =
      (cv::Mat_<double>(3, 3) << camera.fx(), 0, camera.cx(), 0, camera.fy(), camera.cy(), 0, 0, 1);
  cv::Mat D(1, 8, CV_64F);
  for (int i = 0; i < 8; ++i) D.at<double>(0, i) = camera.dist[static_cast<std::size_t>(i)];
  auto rays = std::make_shared<std::vector<cv::Point2d>>();
  std::vector<cv::Point2d> pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) pixels.emplace_back(x, y);
  cv::undistortPoints(pixels, *rays, K, D);
  return [=](int x, int y) {
    const cv::Point2d& ray = (*rays)[static_cast<std::size_t>(y * kWidth + x)];
    const Eigen::Vector3d direction = T_left_camera.linear() * Eigen::Vector3d(ray.x, ray.y, 1.0);
    const Eigen::Vector3d origin = T_left_camera.translation();
    const Eigen::Vector3d p = origin + direction * (depth - origin.z()) / direction.z();
    return texture(p.x() * kFocal / depth, p.y() * kFocal / depth);
  };
}

TEST(StereoRectifier, UndoesDistortionAndRotation) {
  constexpr double kDepth = 2.0;
  const Texture texture(11);
  auto pair = wall_at(30.0);
  for (mrpt::img::TCamera* camera : {&pair->leftCamera, &pair->rightCamera}) {
    camera->distortion = mrpt::img::DistortionModel::plumb_bob;
    camera->dist = {-0.15, 0.03, 0.001, -0.001, 0, 0, 0, 0};
  }
  pair->rightCamera.setIntrinsicParamsFromValues(310.0, 308.0, 155.0, 124.0);
  const mrpt::poses::CPose3D right(kBaseline, 0.004, -0.006, 0.02, -0.03, 0.015);
  pair->rightCameraPose = mrpt::poses::CPose3DQuat(right);
  Eigen::Isometry3d T_left_right = Eigen::Isometry3d::Identity();
  T_left_right.matrix() = right.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen();
  pair->imageLeft =
      image_of(view_of_plane(texture, pair->leftCamera, Eigen::Isometry3d::Identity(), kDepth));
  pair->imageRight = image_of(view_of_plane(texture, pair->rightCamera, T_left_right, kDepth));
  pair->cameraPose = mrpt::poses::CPose3DQuat(mrpt::poses::CPose3D(0, 0, 0, 0, 0, 0));
  StereoFeatures frontend(stereo_parameters("orb", "klt"), "", true);
  const FeatureBatch batch = features_of(frontend, pair);
  ASSERT_GT(batch.size(), 50U);
  EXPECT_LT(frontend.figures().at("mean_row_error_px"), 0.15);
  double sum = 0.0, squares = 0.0;
  for (const Feature& feature : batch) {
    const StereoCamera& camera = *feature.camera;
    const double z = (camera.T_robot_camera * triangulate(camera, feature.z)).z();
    sum += z - kDepth;
    squares += (z - kDepth) * (z - kDepth);
  }
  const auto n = static_cast<double>(batch.size());
  // A disparity of 30 px to 0.2 px is 0.7 % of the depth; interpolation is part of that.
  EXPECT_NEAR(sum / n, 0.0, 0.01);
  EXPECT_LT(std::sqrt(squares / n), 0.04);
}

TEST(StereoMotion, JacobianFreeCheckOfTheEstimate) {
  StereoCamera camera{500.0, 480.0, 320.0, 240.0, 0.3, 640, 480, Eigen::Isometry3d::Identity()};
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> normal;
  const Eigen::Isometry3d T = Eigen::Translation3d(0.1, -0.05, -0.8) *
                              Eigen::AngleAxisd(0.04, Eigen::Vector3d(0.2, 1.0, -0.1).normalized());
  const auto pairs_with = [&](double noise, int wrong) {
    std::vector<SightingPair> pairs;
    for (int i = 0; i < 120; ++i) {
      const double depth = 4.0 + 16.0 * std::abs(unit(random));
      const Eigen::Vector3d p(0.5 * depth * unit(random), 0.4 * depth * unit(random), depth);
      StereoMatch before, after;
      before.sigma = after.sigma = std::max(noise, 1e-3);
      const auto disturb = [&] {
        const double a = normal(random), b = normal(random), c = normal(random), d = normal(random);
        return Eigen::Vector3d(noise * a, noise * 0.5 * (b + c), noise * (a - d));
      };
      before.z = project(camera, p) + disturb();
      after.z = project(camera, T * p) + disturb();
      if (i < wrong) after.z.head<2>() += Eigen::Vector2d(25.0 * unit(random), 40.0);
      SightingPair& pair = pairs.emplace_back();
      locate(camera, before, pair.p_before, pair.cov_before);
      pair.z_after = after.z;
      pair.cov_after = covariance_of(after);
    }
    return pairs;
  };
  const auto exact =
      estimate_stereo_motion(camera, pairs_with(0.0, 0), Eigen::Isometry3d::Identity(), 12.84);
  ASSERT_TRUE(exact);
  EXPECT_TRUE(exact->T_after_before.isApprox(T, 1e-9));
  EXPECT_EQ(exact->support, 120);
  double nees = 0.0;
  constexpr int kRuns = 60;
  for (int run = 0; run < kRuns; ++run) {
    const auto noisy =
        estimate_stereo_motion(camera, pairs_with(0.3, 50), Eigen::Isometry3d::Identity(), 12.84);
    ASSERT_TRUE(noisy);
    for (std::size_t i = 0; i < 50; ++i) EXPECT_FALSE(noisy->agrees[i]);
    const Eigen::Isometry3d error = T * noisy->T_after_before.inverse();
    const Eigen::AngleAxisd turn(error.linear());
    Eigen::Matrix<double, 6, 1> e;
    e << error.translation(), turn.angle() * turn.axis();
    nees += e.dot(noisy->cov.ldlt().solve(e)) / kRuns;
  }
  // 60 runs of 6 degrees: 6 +- 4 standard deviations of the mean, 0.45 each; weights that depend
  // on the noise and a gate that cuts tails are good for another 10 %.
  EXPECT_NEAR(nees, 6.0, 2.4);
}

TEST(StereoMotion, NothingWithoutSupport) {
  const StereoCamera camera{500.0, 500.0, 320.0, 240.0,
                            0.3,   640,   480,   Eigen::Isometry3d::Identity()};
  std::vector<SightingPair> pairs(40);
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> unit;
  for (SightingPair& pair : pairs) {
    StereoMatch match;
    match.sigma = 0.3;
    match.z = {640.0 * unit(random), 480.0 * unit(random), 5.0 + 60.0 * unit(random)};
    locate(camera, match, pair.p_before, pair.cov_before);
    pair.z_after = {640.0 * unit(random), 480.0 * unit(random), 5.0 + 60.0 * unit(random)};
    pair.cov_after = covariance_of(match);
  }
  EXPECT_FALSE(estimate_stereo_motion(camera, pairs, Eigen::Isometry3d::Identity(), 12.84));
  EXPECT_FALSE(estimate_stereo_motion(camera, {}, Eigen::Isometry3d::Identity(), 12.84));
}

}  // namespace
}  // namespace libslam
