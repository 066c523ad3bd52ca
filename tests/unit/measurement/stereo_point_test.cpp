#include <cmath>
#include <limits>
#include <memory>
#include <support/numeric_jacobian.hpp>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <libslam/association/known.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/measurement/stereo_point.hpp>
#include <libslam/motion/body_twist.hpp>
#include <libslam/state/so3.hpp>

namespace libslam {
namespace {

using testing::numeric_jacobian;

/// Axes of a camera that looks forward: Z forward, X right, Y down.
Eigen::Matrix3d forward_axes() {
  return Eigen::Matrix3d{{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}};
}

std::shared_ptr<StereoCamera> make_camera(const Eigen::Vector3d& tilt) {
  auto camera = std::make_shared<StereoCamera>();
  camera->fx = 480.0;
  camera->fy = 470.0;
  camera->cx = 320.0;
  camera->cy = 240.0;
  camera->baseline = 0.24;
  camera->T_robot_camera =
      Eigen::Translation3d(0.3, -0.1, 0.5) * Eigen::Quaterniond(so3_exp(tilt) * forward_axes());
  return camera;
}

Feature make_feature(std::shared_ptr<const StereoCamera> camera, double sigma = 1.0) {
  Feature feature;
  feature.z = Eigen::Vector3d(330.0, 250.0, 20.0);
  feature.cov = sigma * sigma * Eigen::Matrix3d{{1, 0, 1}, {0, 0.5, 0}, {1, 0, 2}};
  feature.camera = std::move(camera);
  return feature;
}

struct Scene {
  GaussianState state;
  BlockId pose, landmark;
};

/// The camera of `feature` on a robot at a pose, and a landmark at `p_camera` in its frame.
Scene make_scene(const BlockSpec& pose_spec, const Eigen::VectorXd& pose, int dimension,
                 const Feature& feature, const Eigen::Vector3d& p_camera) {
  Scene scene;
  const auto n = tangent_dimension(pose_spec);
  scene.pose = scene.state.add(pose_spec, pose, Eigen::MatrixXd::Identity(n, n));
  Eigen::Isometry3d T_world_robot;
  if (pose_spec.chart == Chart::kSE3)
    T_world_robot = Eigen::Translation3d(pose.head<3>()) *
                    Eigen::Quaterniond(pose[6], pose[3], pose[4], pose[5]);
  else
    T_world_robot = Eigen::Translation3d(pose[0], pose[1], 0.0) *
                    Eigen::AngleAxisd(pose[2], Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d m = T_world_robot * feature.camera->T_robot_camera * p_camera;
  scene.landmark =
      scene.state.add({"m", Chart::kVector, dimension, WorldRole::kPoint}, m.head(dimension),
                      Eigen::MatrixXd::Identity(dimension, dimension));
  return scene;
}

const BlockSpec kPlanar{"pose", Chart::kSE2, 3, WorldRole::kPose};
const BlockSpec kSpatial{"pose", Chart::kSE3, 6, WorldRole::kPose};

std::vector<Eigen::VectorXd> poses_of(const BlockSpec& spec) {
  if (spec.chart == Chart::kSE2)
    return {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, -2, 1e-8),
            Eigen::Vector3d(3, 4, M_PI - 1e-9)};
  std::vector<Eigen::VectorXd> poses;
  for (const Eigen::Vector3d& theta :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 1e-8, 0), Eigen::Vector3d(0.4, -1.0, 2.0),
        Eigen::Vector3d(0, 0, M_PI - 1e-9)}) {
    Eigen::VectorXd pose(7);
    pose << 1.0, -2.0, 0.7, so3_exp(theta).coeffs();
    poses.push_back(pose);
  }
  return poses;
}

struct Kind {
  BlockSpec pose;
  int dimension;
  Eigen::Vector3d tilt;
};

/// Every combination of robot and landmark; with two coordinates the camera is level, but turned.
std::vector<Kind> kinds() {
  return {
      {kSpatial, 3, {0.2, -0.1, 0.4}}, {kPlanar, 3, {0.2, -0.1, 0.4}}, {kPlanar, 2, {0, 0, 0.4}}};
}

const std::vector<Eigen::Vector3d> kPoints = {{0, 0, 2}, {1e-8, 0, 1}, {1.5, -0.7, 4}, {-9, 3, 40}};

Eigen::VectorXd difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a - b;
}

TEST(StereoPoint, JacobiansOfThePrediction) {
  for (const Kind& kind : kinds()) {
    const StereoPoint model(kind.dimension);
    const Feature feature = make_feature(make_camera(kind.tilt));
    for (const Eigen::VectorXd& pose : poses_of(kind.pose))
      for (const Eigen::Vector3d& point : kPoints) {
        const Scene s = make_scene(kind.pose, pose, kind.dimension, feature, point);
        LinearizedMeasurement out;
        model.linearize(s.state, s.pose, s.landmark, feature, out);
        ASSERT_EQ(out.innovation.size(), kind.dimension);
        ASSERT_EQ(out.wrt.size(), 2);
        const auto f = [&](const GaussianState& state) {
          return Eigen::VectorXd(model.predict(state, s.pose, s.landmark, feature));
        };
        for (const auto& [block, jacobian] : out.wrt) {
          const Eigen::MatrixXd numeric = numeric_jacobian(s.state, block, f, difference);
          EXPECT_LT((jacobian - numeric).cwiseAbs().maxCoeff(),
                    1e-8 * (1.0 + 480.0 + numeric.cwiseAbs().maxCoeff()))
              << "dimension " << kind.dimension << " point " << point.transpose();
        }
      }
  }
}

TEST(StereoPoint, InitializationExplainsTheFeatureWithItsJacobians) {
  for (const Kind& kind : kinds()) {
    const StereoPoint model(kind.dimension);
    const Feature feature = make_feature(make_camera(kind.tilt));
    for (const Eigen::VectorXd& pose : poses_of(kind.pose)) {
      Scene s = make_scene(kind.pose, pose, kind.dimension, feature, kPoints[2]);
      Initialization out;
      model.initialize(s.state, s.pose, feature, out);
      const auto f = [&](const GaussianState& state) {
        Initialization moved;
        model.initialize(state, s.pose, feature, moved);
        return Eigen::VectorXd(moved.estimate);
      };
      const Eigen::MatrixXd numeric = numeric_jacobian(s.state, s.pose, f, difference);
      EXPECT_LT((out.wrt.begin()->jacobian - numeric).cwiseAbs().maxCoeff(), 1e-7);
      s.state.set_estimate(s.landmark, out.estimate);
      LinearizedMeasurement check;
      model.linearize(s.state, s.pose, s.landmark, feature, check);
      EXPECT_LT(check.innovation.norm(), 1e-10);
      // The noise of the landmark, seen again, is that of the feature.
      const BlockMatrix& H = (check.wrt.begin() + 1)->jacobian;
      EXPECT_LT((H * out.cov_noise * H.transpose() - check.cov).norm(), 1e-9);
    }
  }
}

TEST(StereoPoint, APointBehindTheCameraIsNoPartner) {
  const StereoPoint model(3);
  const Feature feature = make_feature(make_camera({0, 0, 0}));
  for (const double depth : {-2.0, 0.0, 1e-4}) {
    const Scene s =
        make_scene(kSpatial, poses_of(kSpatial)[0], 3, feature, Eigen::Vector3d(0.1, 0.1, depth));
    LinearizedMeasurement out;
    model.linearize(s.state, s.pose, s.landmark, feature, out);
    EXPECT_TRUE(out.innovation.array().isNaN().all());
    EXPECT_TRUE(model.predict(s.state, s.pose, s.landmark, feature).array().isNaN().all());
  }
}

TEST(StereoPoint, LandmarksStartAtKnownDisparitiesOnly) {
  const StereoPoint model(3);
  Feature feature = make_feature(make_camera({0, 0, 0}));  // sigma of d: sqrt(2)
  for (const auto& [d, usable] :
       {std::pair(20.0, true), std::pair(4.25, true), std::pair(4.2, false), std::pair(0.0, false),
        std::pair(-3.0, false)}) {
    feature.z[2] = d;
    EXPECT_EQ(model.initializable(feature), usable) << d;
  }
}

TEST(StereoPoint, RefusesATiltedCameraForPlanarLandmarks) {
  const StereoPoint model(2);
  const Feature tilted = make_feature(make_camera({0.0, 0.01, 0.0}));
  Initialization out;
  GaussianState state;
  const BlockId planar = state.add(kPlanar, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero());
  EXPECT_THROW(model.initialize(state, planar, tilted, out), std::invalid_argument);
  EXPECT_NO_THROW(model.initialize(state, planar, make_feature(make_camera({0, 0, 1})), out));
  const BlockId spatial =
      state.add(kSpatial, poses_of(kSpatial)[0], Eigen::MatrixXd::Identity(6, 6));
  EXPECT_THROW(model.initialize(state, spatial, make_feature(make_camera({0, 0, 0})), out),
               std::invalid_argument);
  EXPECT_THROW(model.initialize(state, planar, Feature{}, out), std::invalid_argument);
  EXPECT_THROW(StereoPoint(4), std::invalid_argument);
}

/// A filter in space, moved and seeing without noise, from a start that it does not know.
TEST(StereoPoint, NoiselessSlamInSpaceReachesZeroError) {
  EkfSlamParts parts;
  TwistParameters noise;
  parts.motion = std::make_unique<BodyTwist>(noise, CalibrationParameters{});
  parts.measurement = std::make_unique<StereoPoint>(3);
  parts.associator = std::make_unique<KnownAssociation>(std::numeric_limits<double>::infinity());
  parts.frame = make_error_frame("right_invariant");
  parts.cov_start = BlockMatrix::Zero(6, 6);
  parts.cov_no_odometry = BlockMatrix::Zero(6, 6);
  EkfSlam filter(std::move(parts));
  const auto camera = make_camera({0.1, 0.0, 0.2});
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const Twist twist = (Twist() << 0.5, 0.1, -0.1, 0.1, -0.2, 0.3).finished();
  for (int k = 0; k < 40; ++k) {
    std::vector<Feature> features;
    const Eigen::Isometry3d T_camera_world = (T * camera->T_robot_camera).inverse();
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d m(6.0 * std::cos(i), 6.0 * std::sin(1.7 * i), 4.0 * std::sin(2.3 * i));
      const Eigen::Vector3d p = T_camera_world * m;
      if (p.z() < 1.0) continue;
      Feature feature = make_feature(camera, 0.5);
      feature.id = i;
      feature.z = Eigen::Vector3d(camera->cx + camera->fx * p.x() / p.z(),
                                  camera->cy + camera->fy * p.y() / p.z(),
                                  camera->fx * camera->baseline / p.z());
      features.push_back(feature);
    }
    filter.update(features);
    MotionAction action;
    action.dt = 0.1;
    action.twist = twist;
    filter.propagate(&action);
    const Eigen::Vector3d theta = 0.1 * twist.tail<3>();
    T = T * Eigen::Translation3d(so3_left_jacobian(theta) * (0.1 * twist.head<3>())) *
        so3_exp(theta);
  }
  const auto x = filter.state().estimate(filter.pose());
  EXPECT_LT((x.head<3>() - T.translation()).norm(), 1e-9);
  EXPECT_LT((Eigen::Quaterniond(x[6], x[3], x[4], x[5]).toRotationMatrix() - T.linear()).norm(),
            1e-9);
  EXPECT_GT(filter.registry().size(), 20U);
}

}  // namespace
}  // namespace libslam
