// The files for MRPT's tools are read back with MRPT.

#include <random>
#include <sstream>

#include <gtest/gtest.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/math/CQuaternion.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/opengl/CEllipsoid2D.h>
#include <mrpt/opengl/CEllipsoid3D.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/poses/CPose3D.h>

#include <libslam/io/exporters/kitti_poses.hpp>
#include <libslam/io/exporters/scene_3d.hpp>
#include <libslam/io/exporters/simple_map.hpp>

#include "sample_run.hpp"
#include "spatial_run.hpp"

namespace libslam {
namespace {

Trajectory path_of(const sample::Run& run) {
  Trajectory path;
  for (const StepRecord& step : run.steps) path.poses.push_back(step.pose);
  return path;
}

mrpt::obs::CSensoryFrame::Ptr frame_with(std::int32_t landmark) {
  auto observation = mrpt::obs::CObservationBearingRange::Create();
  observation->sensedData.resize(1);
  observation->sensedData[0].landmarkID = landmark;
  auto frame = mrpt::obs::CSensoryFrame::Create();
  frame->insert(observation);
  return frame;
}

TEST(Scene3d, HoldsPathRobotAndAnEllipsoidPerLandmark) {
  const sample::TemporaryFolder folder("scene");
  sample::Run run = sample::make_run(100, 20);
  run.map.add({500, "point", Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(1, 4, 9).asDiagonal(), 1});
  run.map.add({501, "line", Eigen::Vector2d(1, 2), Eigen::Matrix2d::Identity(), 1});
  const auto file = folder.path() / "scene.3Dscene";
  write_scene_3d(file, path_of(run), run.map);

  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile(file.string()));
  ASSERT_TRUE(scene.getByClass<mrpt::opengl::CSetOfLines>());
  EXPECT_EQ(scene.getByClass<mrpt::opengl::CSetOfLines>()->size(), 99u);
  EXPECT_TRUE(scene.getByName("robot"));
  int flat = 0;
  while (scene.getByClass<mrpt::opengl::CEllipsoid2D>(static_cast<std::size_t>(flat))) ++flat;
  EXPECT_EQ(flat, 24);
  const auto solid = scene.getByClass<mrpt::opengl::CEllipsoid3D>();
  ASSERT_TRUE(solid);
  EXPECT_EQ(solid->getName(), "500");
  EXPECT_NEAR(solid->getPoseZ(), 3.0, 1e-6);
  EXPECT_NEAR(static_cast<double>(solid->getCovMatrix()(2, 2)), 9.0, 1e-6);
  EXPECT_FALSE(scene.getByName("501"));
}

TEST(Scene3d, APathInSpaceIsDrawnThere) {
  const sample::TemporaryFolder folder("scene");
  const sample::Run run = sample::make_spatial_run(50, 21);
  const auto file = folder.path() / "scene.3Dscene";
  write_scene_3d(file, run.truth.path, run.map);
  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile(file.string()));
  const SpatialPose& last = run.truth.path.spatial.back();
  double x0, y0, z0, x1, y1, z1;
  scene.getByClass<mrpt::opengl::CSetOfLines>()->getLineByIndex(48, x0, y0, z0, x1, y1, z1);
  EXPECT_LT((Eigen::Vector3d(x1, y1, z1) - last.position).norm(), 1e-5);  // drawn in floats
  const mrpt::poses::CPose3D robot(scene.getByName("robot")->getPose());
  const Eigen::Matrix3d R = robot.getRotationMatrix().asEigen();
  EXPECT_LT((R - last.rotation.toRotationMatrix()).norm(), 1e-5);
}

TEST(KittiPoses, RowsAreThreeByFourAndReadBack) {
  const sample::Run run = sample::make_spatial_run(5, 22);
  std::istringstream text(kitti_poses_text(run.truth.path));
  for (const SpatialPose& pose : run.truth.path.spatial) {
    const Eigen::Matrix4d T = pose.isometry().matrix();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j) {
        double value = 0.0;
        ASSERT_TRUE(text >> value);
        EXPECT_EQ(value, T(i, j));
      }
  }
  std::string rest;
  EXPECT_FALSE(text >> rest);
  Trajectory planar;
  planar.poses.emplace_back(1.5, -2, 0);
  EXPECT_EQ(kitti_poses_text(planar), "1 0 0 1.5 0 1 0 -2 0 0 1 0\n");
}

TEST(Scene3d, EmptyRunAndUnwritableFile) {
  const sample::TemporaryFolder folder("scene");
  EXPECT_NO_THROW(write_scene_3d(folder.path() / "scene.3Dscene", {}, {}));
  try {
    write_scene_3d("/nonexistent/scene.3Dscene", {}, {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nonexistent/scene.3Dscene"), std::string::npos);
  }
}

TEST(SimpleMapWriter, PairsReadBackWithPoseCovarianceAndFrame) {
  const sample::TemporaryFolder folder("simplemap");
  SimpleMapWriter writer;
  const Eigen::Matrix3d cov = Eigen::Vector3d(0.01, 0.04, 0.0009).asDiagonal();
  writer.add({0, 0, 0}, cov, frame_with(1));
  writer.add({0.2, 0, 0.1}, cov, frame_with(2));  // too near
  writer.add({1, 2, -3}, 2 * cov, nullptr);       // nothing seen
  writer.add({0.2, 0, 0.5}, 2 * cov, frame_with(3));
  ASSERT_EQ(writer.size(), 2u);
  const auto file = folder.path() / "map.simplemap";
  writer.write(file);

  mrpt::maps::CSimpleMap map;
  ASSERT_TRUE(map.loadFromFile(file.string()));
  ASSERT_EQ(map.size(), 2u);
  const auto [pose, frame] = map.get(1);
  const auto [covariance, mean] = pose->getCovarianceAndMean();
  EXPECT_NEAR(mean.yaw(), 0.5, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 0.08, 1e-12);
  EXPECT_NEAR(covariance(3, 3), 0.0018, 1e-12);
  EXPECT_EQ(
      frame->getObservationByClass<mrpt::obs::CObservationBearingRange>()->sensedData[0].landmarkID,
      3);
}

// The covariance of MRPT's angles against samples: 2e5 draws, relative error of a variance
// sqrt(2 / n) = .3 %; the angles are not linear in the rotation, with sigmas of .01 to second
// order.
TEST(SimpleMapWriter, PosesInSpaceKeepTheirOrientationAndCovariance) {
  const sample::TemporaryFolder folder("simplemap");
  SpatialEstimate estimate = *sample::make_spatial_run(40, 23).steps.back().spatial;
  estimate.cov.diagonal().tail<3>().setConstant(4e-4);
  SimpleMapWriter writer;
  writer.add(estimate, frame_with(1));
  writer.add(estimate, frame_with(2));  // too near
  estimate.pose.rotation = sample::rotation({0.5, 0, 0}) * estimate.pose.rotation;
  writer.add(estimate, frame_with(3));
  ASSERT_EQ(writer.size(), 2u);
  writer.write(folder.path() / "map.simplemap");
  mrpt::maps::CSimpleMap map;
  ASSERT_TRUE(map.loadFromFile((folder.path() / "map.simplemap").string()));
  const auto [covariance, mean] = std::get<0>(map.get(1))->getCovarianceAndMean();
  const auto angles_of = [](const Eigen::Quaterniond& q) {
    const mrpt::poses::CPose3D pose(mrpt::math::CQuaternionDouble(q.w(), q.x(), q.y(), q.z()), 0, 0,
                                    0);
    return Eigen::Vector3d(pose.yaw(), pose.pitch(), pose.roll());
  };
  const Eigen::Vector3d angles(mean.yaw(), mean.pitch(), mean.roll());
  EXPECT_LT((angles - angles_of(estimate.pose.rotation)).norm(), 1e-12);
  std::mt19937 generator(24);
  std::normal_distribution<double> normal;
  const Eigen::Matrix<double, 6, 6> root = estimate.cov.llt().matrixL();
  Eigen::Matrix<double, 6, 6> sampled = Eigen::Matrix<double, 6, 6>::Zero();
  constexpr int kDraws = 200000;
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::VectorXd d =
        root * Eigen::VectorXd::NullaryExpr(6, [&](auto) { return normal(generator); });
    Eigen::Matrix<double, 6, 1> e;
    e << d.head<3>(), angles_of(sample::rotation(d.tail<3>()) * estimate.pose.rotation) - angles;
    sampled += e * e.transpose() / kDraws;
  }
  const Eigen::Matrix<double, 6, 6> stored = covariance.asEigen();
  EXPECT_LT((sampled - stored).norm(), 0.02 * stored.norm());
  const Eigen::Matrix3d angular = stored.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d off = (sampled - stored).bottomRightCorner<3, 3>();
  EXPECT_LT(off.norm(), 0.02 * angular.norm());
}

TEST(SimpleMapWriter, MemoryIsBoundedAndTheWholePathStaysCovered) {
  SimpleMapWriter writer({1.0, 0.35}, 10);
  for (int i = 0; i < 1000; ++i) {
    writer.add({static_cast<double>(i), 0, 0}, Eigen::Matrix3d::Identity(), frame_with(i));
    ASSERT_LE(writer.size(), 10u);
  }
  const sample::TemporaryFolder folder("simplemap");
  writer.write(folder.path() / "map.simplemap");
  mrpt::maps::CSimpleMap map;
  ASSERT_TRUE(map.loadFromFile((folder.path() / "map.simplemap").string()));
  EXPECT_GE(map.size(), 5u);
  mrpt::poses::CPose3D first, last;
  std::get<0>(map.get(0))->getMean(first);
  std::get<0>(map.get(map.size() - 1))->getMean(last);
  EXPECT_EQ(first.x(), 0.0);
  EXPECT_GT(last.x(), 800.0);
}

TEST(SimpleMapWriter, KeyPosesMoveToTheCorrectedPath) {
  SimpleMapWriter writer;
  for (int i = 0; i < 3; ++i)
    writer.add({1.0 * i, 0, 0}, 0.1 * Eigen::Matrix3d::Identity(), frame_with(i), 10.0 + i);
  writer.correct({{10, 11, 11.5}, {{5, 6, 0.1}, {7, 8, 0.2}, {9, 9, 9}}, {}});
  const mrpt::maps::CSimpleMap map = writer.map();
  const auto [cov, mean] = std::get<0>(map.get(1))->getCovarianceAndMean();
  EXPECT_NEAR(mean.x(), 7.0, 1e-12);
  EXPECT_NEAR(mean.y(), 8.0, 1e-12);
  EXPECT_NEAR(mean.yaw(), 0.2, 1e-12);
  EXPECT_NEAR(cov(0, 0), 0.1, 1e-12);
  EXPECT_NEAR(std::get<0>(map.get(2))->getMeanVal().x(), 2.0, 1e-12);  // no such time
}

TEST(SimpleMapWriter, RefusesNonsense) {
  EXPECT_THROW(SimpleMapWriter({1.0, 0.35}, 1), std::invalid_argument);
  EXPECT_THROW(SimpleMapWriter({-1.0, 0.35}), std::invalid_argument);
  EXPECT_THROW(SimpleMapWriter().write("/nonexistent/map.simplemap"), std::runtime_error);
}

}  // namespace
}  // namespace libslam
