#include <algorithm>
#include <bench/ring_world.hpp>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>
#include <string>

#include <Eigen/Dense>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <libslam/config/parameters.hpp>
#include <libslam/frontend/odometry.hpp>
#include <libslam/pipeline/factory.hpp>

namespace libslam::bench {

namespace {

using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CObservationBearingRange;
using mrpt::poses::CPose2D;

// MRPT predicts every landmark up to 15 m beyond the range of the sensor; with landmarks this far
// apart those are few, and the comparison is about the update.
constexpr double kSpacing = 10.0;       // [m]
constexpr double kInside = 10.0;        // the robot's circle lies inside the ring by this [m]
constexpr double kSigmaXY = 0.01;       // odometry per step [m]
constexpr double kSigmaHeading = 5e-5;  // [rad]: laps of 16 km must close within the linear range

class Generator {
 public:
  explicit Generator(int landmarks)
      : landmarks_(landmarks),
        steps_(landmarks / RingWorld::kAdvance),
        radius_(kSpacing * landmarks / (2.0 * kPi)) {}

  int steps() const { return steps_; }
  CPose2D true_pose(int step) const {
    const double angle = 2.0 * kPi * step / steps_;
    const double r = radius_ - kInside;
    return {r * std::cos(angle), r * std::sin(angle), angle + 0.5 * kPi};
  }

  mrpt::obs::CActionCollection::Ptr action(int step) {
    const CPose2D increment = true_pose(step) - true_pose(step - 1);
    CActionRobotMovement2D motion;
    motion.rawOdometryIncrementReading = {increment.x() + kSigmaXY * normal_(random_),
                                          increment.y() + kSigmaXY * normal_(random_),
                                          increment.phi() + kSigmaHeading * normal_(random_)};
    mrpt::math::CMatrixDouble33 cov;
    cov(0, 0) = cov(1, 1) = kSigmaXY * kSigmaXY;
    cov(2, 2) = kSigmaHeading * kSigmaHeading;
    motion.poseChange =
        mrpt::poses::CPosePDFGaussian::Create(motion.rawOdometryIncrementReading, cov);
    motion.estimationMethod = CActionRobotMovement2D::emOdometry;
    auto actions = std::make_shared<mrpt::obs::CActionCollection>();
    actions->insert(motion);
    return actions;
  }

  mrpt::obs::CSensoryFrame::Ptr frame(int step) {
    auto observation = std::make_shared<CObservationBearingRange>();
    observation->fieldOfView_yaw = static_cast<float>(2.0 * kPi);
    observation->sensor_std_range = static_cast<float>(RingWorld::kSigmaRange);
    observation->sensor_std_yaw = static_cast<float>(RingWorld::kSigmaBearing);
    const CPose2D pose = true_pose(step);
    for (int k = 0; k < RingWorld::kSeen; ++k) {
      const int landmark = RingWorld::kAdvance * step + k - RingWorld::kSeen / 2;
      const double angle = 2.0 * kPi * landmark / landmarks_;
      const auto seen =
          pose.inverseComposePoint({radius_ * std::cos(angle), radius_ * std::sin(angle)});
      CObservationBearingRange::TMeasurement measured{};
      measured.landmarkID = (landmark + landmarks_) % landmarks_;
      measured.range = static_cast<float>(seen.norm() + RingWorld::kSigmaRange * normal_(random_));
      measured.yaw = static_cast<float>(std::atan2(seen.y, seen.x) +
                                        RingWorld::kSigmaBearing * normal_(random_));
      observation->sensedData.push_back(measured);
      observation->maxSensorDistance = std::max(observation->maxSensorDistance, measured.range);
    }
    auto frame = std::make_shared<mrpt::obs::CSensoryFrame>();
    frame->insert(observation);
    return frame;
  }

 private:
  int landmarks_, steps_;
  double radius_;
  std::mt19937_64 random_{71};
  std::normal_distribution<double> normal_;
};

}  // namespace

RingWorld::RingWorld(int landmarks) {
  if (landmarks % kAdvance != 0 || landmarks < 2 * kSeen)
    throw std::invalid_argument("a ring of " + std::to_string(landmarks) + " landmarks");
  Generator generator(landmarks);
  const Parameters parameters;
  OdometryReader odometry(parameters.input);
  const auto frontend = make_frontend(parameters);
  std::vector<FeatureBatch> batches;
  for (int k = 0; k < generator.steps(); ++k) {
    RingStep& step = lap.emplace_back();
    step.log.index = k;
    step.log.has_motion_covariance = true;
    step.log.action = generator.action(k);
    step.log.frame = generator.frame(k);
    step.action = odometry.read(step.log).value();
    frontend->extract(*step.log.frame, batches);
    step.features = batches.at(0);
    const CPose2D truth = generator.true_pose(k) - generator.true_pose(0);
    step.truth = {truth.x(), truth.y(), truth.phi()};
  }
}

const RingWorld& ring_world(int landmarks) {
  static std::map<int, RingWorld> worlds;
  return worlds.try_emplace(landmarks, landmarks).first->second;
}

}  // namespace libslam::bench
