#pragma once
// A head with a stereo camera, a gyro and a speedometer among landmarks, in place of real drivers:
// what it senses comes as the observations of MRPT.

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Dense>  // before MRPT's matrices
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationStereoImagesFeatures.h>

class SimulatedHead {
 public:
  static constexpr double kPeriod = 0.05;  // [s] between readings of gyro and speed
  // True standard deviations of what it senses.
  static constexpr double kSigmaPixel = 0.5, kSigmaSpeed = 0.05, kSigmaRate = 0.01;

  explicit SimulatedHead(unsigned seed) : random_(seed) {
    std::uniform_real_distribution<double> wide(-12.0, 12.0), high(-3.0, 3.0);
    for (int i = 0; i < 150; ++i)
      landmarks.emplace_back(wide(random_), wide(random_), high(random_));
  }

  /// The true pose: T_world_head.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3d> landmarks;  ///< in the world [m]; the identity is the position
  double time = 1000.0;                    ///< [s]

  /// Moves on by one period and returns what gyro and speedometer said at its beginning.
  std::vector<mrpt::obs::CObservation::Ptr> move() {
    const double t = time - 1000.0;
    // Around in a circle, nodding and swaying.
    const Eigen::Vector3d rate(0.3 * std::cos(0.9 * t), 0.2 * std::cos(1.3 * t), 0.25);
    const Eigen::Vector3d speed(1.0, 0.0, 0.0);
    const std::vector<mrpt::obs::CObservation::Ptr> readings = {read_gyro(rate), read_speed(speed)};
    constexpr int kParts = 20;
    for (int i = 0; i < kParts; ++i) {
      const double dt = kPeriod / kParts;
      pose.translate(speed * dt);
      pose.rotate(Eigen::AngleAxisd(rate.norm() * dt, rate.normalized()));
    }
    time += kPeriod;
    return readings;
  }

  /// What the camera sees now: the landmarks in both images with their identities.
  mrpt::obs::CObservation::Ptr look() {
    auto seen = mrpt::obs::CObservationStereoImagesFeatures::Create();
    seen->timestamp = mrpt::Clock::fromDouble(time);
    seen->sensorLabel = "camera";
    seen->cameraLeft = seen->cameraRight = camera();
    constexpr double kBaseline = 0.2;  // [m]
    seen->rightCameraPose = mrpt::poses::CPose3DQuat(kBaseline, 0.0, 0.0, {1.0, 0.0, 0.0, 0.0});
    // The camera looks forward, 10 cm above the origin of the head: Z is x, X is -y, Y is -z.
    seen->cameraPoseOnRobot = mrpt::poses::CPose3DQuat(0.0, 0.0, 0.1, {0.5, -0.5, 0.5, -0.5});
    const Eigen::Isometry3d T_head_camera =
        Eigen::Translation3d(0.0, 0.0, 0.1) * Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
    const Eigen::Isometry3d T_camera_world = (pose * T_head_camera).inverse();
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      const Eigen::Vector3d p = T_camera_world * landmarks[i];
      if (p.z() < 0.5 || p.z() > 10.0) continue;
      const double u = kFocal * p.x() / p.z() + kCentreX, v = kFocal * p.y() / p.z() + kCentreY;
      const double disparity = kFocal * kBaseline / p.z();
      if (u - disparity < 0.0 || u > 2.0 * kCentreX || v < 0.0 || v > 2.0 * kCentreY) continue;
      mrpt::obs::TStereoImageFeatures point;
      point.ID = static_cast<unsigned>(i);
      point.pixels.first = noisy_pixel(u, v);
      point.pixels.second = noisy_pixel(u - disparity, v);
      seen->theFeatures.push_back(point);
    }
    return seen;
  }

 private:
  static constexpr double kFocal = 400.0, kCentreX = 320.0, kCentreY = 240.0;  // [px]

  static mrpt::img::TCamera camera() {
    mrpt::img::TCamera camera;
    camera.ncols = 640;
    camera.nrows = 480;
    camera.setIntrinsicParamsFromValues(kFocal, kFocal, kCentreX, kCentreY);
    return camera;
  }

  mrpt::obs::CObservation::Ptr read_gyro(const Eigen::Vector3d& rate) {
    auto imu = mrpt::obs::CObservationIMU::Create();
    imu->timestamp = mrpt::Clock::fromDouble(time);
    imu->set(mrpt::obs::IMU_WX, noisy(rate.x(), kSigmaRate));
    imu->set(mrpt::obs::IMU_WY, noisy(rate.y(), kSigmaRate));
    imu->set(mrpt::obs::IMU_WZ, noisy(rate.z(), kSigmaRate));
    return imu;
  }

  mrpt::obs::CObservation::Ptr read_speed(const Eigen::Vector3d& speed) {
    auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->timestamp = mrpt::Clock::fromDouble(time);
    odometry->hasVelocities = true;
    odometry->velocityLocal = {noisy(speed.x(), kSigmaSpeed), noisy(speed.y(), kSigmaSpeed), 0.0};
    return odometry;
  }

  mrpt::img::TPixelCoordf noisy_pixel(double u, double v) {
    const double noisy_u = noisy(u, kSigmaPixel), noisy_v = noisy(v, kSigmaPixel);
    return {static_cast<float>(noisy_u), static_cast<float>(noisy_v)};
  }

  double noisy(double value, double sigma) { return value + sigma * normal_(random_); }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};
