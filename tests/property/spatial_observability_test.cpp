// A shift and any turn of the whole world change nothing that a camera in space sees, so no filter
// may gain information about them. Gravity plays no part: all six directions are unobservable.

#include <array>
#include <limits>
#include <memory>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/association/known.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/measurement/stereo_point.hpp>
#include <libslam/motion/body_twist.hpp>
#include <libslam/state/so3.hpp>

using namespace libslam;

namespace {

/// A camera that wanders among points all around, with noise everywhere.
class SpatialDrive {
 public:
  SpatialDrive(const char* frame, unsigned seed) : random_(seed), filter_(make(frame)) {
    auto camera = std::make_shared<StereoCamera>();
    camera->fx = camera->fy = 400.0;
    camera->baseline = 0.3;
    camera->T_robot_camera.translation() = Eigen::Vector3d(0.2, 0.1, -0.1);
    camera_ = std::move(camera);
    for (auto& landmark : landmarks_)
      landmark = Eigen::Vector3d(normal(), normal(), normal()).normalized() * 5.0;
  }

  const EkfSlam& filter() const { return filter_; }

  void move() {
    const Twist twist = (Twist() << 0.6, 0.2, -0.1, 0.3, -0.5, 0.8).finished();
    MotionAction action;
    action.dt = 0.2;
    action.twist = twist;
    for (double& value : *action.twist) value += 0.05 * normal();
    filter_.propagate(&action);
    const Eigen::Vector3d theta = 0.2 * twist.tail<3>();
    T_ = T_ * Eigen::Translation3d(so3_left_jacobian(theta) * (0.2 * twist.head<3>())) *
         so3_exp(theta);
  }

  void look() {
    std::vector<Feature> features;
    const Eigen::Isometry3d T_camera_world = (T_ * camera_->T_robot_camera).inverse();
    for (std::size_t i = 0; i < landmarks_.size(); ++i) {
      const Eigen::Vector3d p = T_camera_world * landmarks_[i];
      if (p.z() < 1.0 || p.head<2>().norm() > 1.5 * p.z()) continue;
      Feature feature;
      feature.id = static_cast<std::int64_t>(i);
      feature.camera = camera_;
      feature.cov = Eigen::Matrix3d{{1, 0, 1}, {0, 0.5, 0}, {1, 0, 2}};
      feature.z = Eigen::Vector3d(400.0 * p.x() / p.z(), 400.0 * p.y() / p.z(), 120.0 / p.z()) +
                  Eigen::Vector3d(normal(), 0.7 * normal(), 1.4 * normal());
      features.push_back(feature);
    }
    filter_.update(features);
  }

  /// n^T P^-1 n for the three shifts and the three turns of the world.
  Eigen::Matrix<double, 6, 1> information() const {
    const GaussianState& state = filter_.state();
    Eigen::MatrixXd N = Eigen::MatrixXd::Zero(state.dimension(), 6);
    for (const BlockId block : state.blocks()) {
      if (state.spec(block).role == WorldRole::kNone) continue;
      N.block<3, 3>(state.offset(block), 0).setIdentity();
      N.block<3, 3>(state.offset(block), 3) = -skew(state.estimate(block).head<3>());
    }
    N.block<3, 3>(state.offset(filter_.pose()) + 3, 3).setIdentity();
    return (N.transpose() * state.full_covariance().ldlt().solve(N)).diagonal();
  }

 private:
  double normal() { return normal_(random_); }
  static EkfSlam make(const char* frame) {
    EkfSlamParts parts;
    TwistParameters noise;
    noise.sigma_rate_x = noise.sigma_rate_y = noise.sigma_rate_z = 0.05;
    CalibrationParameters calibration;
    calibration.bias_gyro_z.enabled = true;
    parts.motion = std::make_unique<BodyTwist>(noise, calibration);
    parts.measurement = std::make_unique<StereoPoint>(3);
    parts.associator = std::make_unique<KnownAssociation>(std::numeric_limits<double>::infinity());
    parts.frame = make_error_frame(frame);
    // The information along the directions is that of the start: without any, P has no inverse.
    parts.cov_start = BlockMatrix::Identity(6, 6) * 0.01;
    parts.cov_no_odometry = BlockMatrix::Zero(6, 6);
    return EkfSlam(std::move(parts));
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  EkfSlam filter_;
  std::shared_ptr<const StereoCamera> camera_;
  std::array<Eigen::Vector3d, 30> landmarks_;
  Eigen::Isometry3d T_ = Eigen::Isometry3d::Identity();
};

/// Largest sum over the directions of the relative gains of all updates.
double gain_of_updates(const char* frame) {
  SpatialDrive drive(frame, *rc::gen::inRange(0u, 1'000'000u));
  drive.look();
  Eigen::Matrix<double, 6, 1> gained = Eigen::Matrix<double, 6, 1>::Zero();
  for (int k = 0; k < 20; ++k) {
    drive.move();
    const Eigen::Matrix<double, 6, 1> before = drive.information();
    drive.look();
    gained += (drive.information() - before).cwiseMax(0.0).cwiseQuotient(before);
  }
  return gained.maxCoeff();
}

// Rounding of the inverse of a state of 100 numbers whose variances span eight decades, 20 times.
constexpr double kRounding = 1e-5;

}  // namespace

RC_GTEST_PROP(UnobservableWorld, IsKeptByTheInvariantFrameInSpace, ()) {
  RC_ASSERT(gain_of_updates("right_invariant") < kRounding);
}

// The check can fail: the textbook filter gains information in every world.
RC_GTEST_PROP(UnobservableWorld, ShrinksInTheStandardFrameInSpace, ()) {
  RC_ASSERT(gain_of_updates("standard") > 1e-3);
}
