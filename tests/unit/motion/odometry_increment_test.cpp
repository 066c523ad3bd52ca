#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <libslam/motion/odometry_increment.hpp>

#include "motion_fixture.hpp"

namespace libslam {
namespace {

using namespace testing;

MotionParameters parameters(const std::string& form) {
  MotionParameters motion;
  motion.increment_form = form;
  motion.noise = small_noise();
  return motion;
}

CalibrationParameters calibrated() {
  CalibrationParameters calibration;
  calibration.scale_speed.enabled = calibration.scale_turn.enabled = true;
  calibration.bias_turn.enabled = true;
  return calibration;
}

/// scale_speed, scale_turn, bias_turn [rad/m].
const Eigen::Vector3d kNeutral(1.0, 1.0, 0.0), kTrue(1.04, 0.97, -0.06), kBiased(1.0, 1.0, -0.06);

Eigen::Matrix3d some_covariance() {
  Eigen::Matrix3d a;
  a << 2e-3, 1e-3, -4e-4, 0, 1e-3, 5e-4, 0, 0, 3e-3;
  return a * a.transpose();
}

TEST(OdometryIncrement, EqualsMrptComposition) {
  const OdometryIncrement model(parameters("composition"), {});
  for (const auto& pose : poses_by_regime()) {
    for (const auto& increment : increments_by_regime()) {
      MotionAction action = action_of(increment);
      action.cov_increment = some_covariance();
      const MotionStep step = MotionState(model, pose, Eigen::VectorXd()).step(model, action);

      const mrpt::poses::CPose2D before(pose.x(), pose.y(), pose.z());
      const mrpt::poses::CPose2D moved =
          before + mrpt::poses::CPose2D(increment.x(), increment.y(), increment.z());
      mrpt::poses::CPosePDFGaussian noise;
      noise.cov = mrpt::math::CMatrixDouble33(some_covariance());
      noise.rotateCov(pose.z());
      EXPECT_NEAR(step.estimate[0], moved.x(), 1e-12);
      EXPECT_NEAR(step.estimate[1], moved.y(), 1e-12);
      EXPECT_NEAR(wrap_angle(step.estimate[2] - moved.phi()), 0.0, 1e-12);
      EXPECT_LT((step.cov_noise - noise.cov.asEigen()).cwiseAbs().maxCoeff(), 1e-12);
    }
  }
}

TEST(OdometryIncrement, JacobiansByRegime) {
  for (const char* form : {"composition", "arc"}) {
    const OdometryIncrement model(parameters(form), {});
    for (const auto& pose : poses_by_regime()) {
      for (const auto& increment : increments_by_regime()) {
        expect_jacobians(model, pose, Eigen::VectorXd(), action_of(increment));
      }
    }
  }
}

TEST(OdometryIncrement, CalibrationJacobiansByRegime) {
  for (const char* form : {"composition", "arc"}) {
    const OdometryIncrement model(parameters(form), calibrated());
    ASSERT_EQ(model.calibration().size(), 3u);
    for (const auto& pose : poses_by_regime())
      for (const auto& increment : increments_by_regime())
        for (const Eigen::Vector3d& values : {kNeutral, kTrue, Eigen::Vector3d(1.0, 1.0, 1e-8)})
          expect_jacobians(model, pose, values, action_of(increment));
  }
}

TEST(OdometryIncrement, NeutralCalibrationIsThePlainModel) {
  for (const char* form : {"composition", "arc"}) {
    const OdometryIncrement model(parameters(form), calibrated()), plain(parameters(form), {});
    for (const auto& pose : poses_by_regime())
      for (const auto& increment : increments_by_regime()) {
        const MotionAction action = action_of(increment);
        const MotionStep a = MotionState(model, pose, kNeutral).step(model, action);
        const MotionStep b = MotionState(plain, pose, {}).step(plain, action);
        EXPECT_LT(boxminus(kPoseSpec, a.estimate, b.estimate).norm(), 1e-14);
        EXPECT_LT((a.cov_noise - b.cov_noise).norm(), 1e-18);
      }
  }
}

// The true wheels and track by which the odometry is wrong, driven through in fine steps.
TEST(OdometryIncrement, CalibrationUndoesWheelsAndATrackThatAreWrong) {
  constexpr double kTrack = 0.4, kTrueTrack = 0.42, kLeft = 1.03, kRight = 0.98;
  const OdometryIncrement model(parameters("composition"), calibrated());
  // The robot turns by (R r - L l) / b where the odometry says (r - l) / b0, r and l the paths of
  // the wheels: with ds = (r + l) / 2 and dphi, r = ds + b0 dphi / 2, l = ds - b0 dphi / 2.
  // Likewise its path is (R r + L l) / 2, which has a term in dphi: the model has none, so it turns
  // little.
  const double mean = 0.5 * (kLeft + kRight), apart = kRight - kLeft;
  const Eigen::Vector3d values(mean, mean * kTrack / kTrueTrack, apart / kTrueTrack);
  for (const double turn : {0.0, 0.02, -0.3}) {
    const double length = 0.5, left = length - 0.5 * kTrack * turn,
                 right = length + 0.5 * kTrack * turn;
    const double true_turn = (kRight * right - kLeft * left) / kTrueTrack;
    const double true_length = 0.5 * (kRight * right + kLeft * left);
    const Eigen::Vector3d truth = integrate({1, 2, 3}, 1.0, 100, [&](const Eigen::Vector3d& p) {
      return Eigen::Vector3d(true_length * std::cos(p[2]), true_length * std::sin(p[2]), true_turn);
    });
    const MotionAction action = action_of_twist(length, turn, 1.0);
    const Eigen::Vector3d moved = move(model, {1, 2, 3}, values, action);
    EXPECT_NEAR(wrap_angle(moved[2] - truth[2]), 0.0, 1e-9);
    const double missing = std::abs(0.25 * apart * kTrack * turn);
    EXPECT_LT((moved - truth).head<2>().norm(), missing + 1e-9);
  }
}

TEST(OdometryIncrement, ABiasTurnsOnTheRoadAlone) {
  const OdometryIncrement model(parameters("composition"), calibrated());
  const Eigen::Vector3d standing = move(model, {1, 2, 0.5}, kTrue, action_of({0, 0, 0}));
  EXPECT_LT((standing - Eigen::Vector3d(1, 2, 0.5)).norm(), 1e-15);
  const Eigen::Vector3d ahead = move(model, {0, 0, 0}, kBiased, action_of({2, 0, 0}));
  EXPECT_NEAR(ahead[2], -0.12, 1e-12);
  const Eigen::Vector3d back = move(model, {0, 0, 0}, kBiased, action_of({-2, 0, 0}));
  EXPECT_NEAR(back[2], 0.12, 1e-12);
}

TEST(OdometryIncrement, SamplesFollowTheLinearization) {
  for (const char* form : {"composition", "arc"}) {
    const OdometryIncrement model(parameters(form), {});
    MotionAction action = action_of({0.5, 0.1, 0.4});
    expect_moments(model, {1.0, 2.0, 3.0}, Eigen::VectorXd(), action, 1);
    action.cov_increment = some_covariance();
    expect_moments(model, {1.0, 2.0, 3.0}, Eigen::VectorXd(), action, 2);
    action.cov_increment->col(1).setZero();  // singular: no sideways noise
    action.cov_increment->row(1).setZero();
    expect_moments(model, {1.0, 2.0, 3.0}, Eigen::VectorXd(), action, 3);
    const OdometryIncrement of_wheels(parameters(form), calibrated());
    expect_moments(of_wheels, {1.0, 2.0, 3.0}, kTrue, action_of({0.5, 0.1, 0.4}), 4);
  }
}

TEST(OdometryIncrement, ConfiguredNoiseWinsWithoutFromLog) {
  MotionParameters motion = parameters("composition");
  motion.noise.from_log = false;
  const OdometryIncrement model(motion, {});
  MotionAction action = action_of({0.5, 0.0, 0.0});
  const auto without = MotionState(model, {0, 0, 0}, {}).step(model, action).cov_noise;
  action.cov_increment = Eigen::Matrix3d::Identity();
  const auto with = MotionState(model, {0, 0, 0}, {}).step(model, action).cov_noise;
  EXPECT_EQ(without, with);
  const NoiseVector variance = OdometryNoise(motion.noise).variance(0.1, 0.5, 0.0);
  EXPECT_TRUE(with.isApprox(Eigen::Matrix3d(variance.head<3>().asDiagonal()), 1e-14));
}

TEST(OdometryIncrement, ArcFormReproducesAnArcAndDropsTheSlip) {
  const OdometryIncrement arc(parameters("arc"), {});
  const MotionAction action = action_of_twist(1.5, 0.8, 0.5);
  const Eigen::Vector3d pose(1.0, 2.0, 0.3);
  const OdometryIncrement composition(parameters("composition"), {});
  EXPECT_LT((move(arc, pose, {}, action) - move(composition, pose, {}, action)).norm(), 1e-14);
  EXPECT_LT(move(arc, {0, 0, 0}, {}, action_of({0.0, 0.2, 0.0})).norm(), 1e-15);
}

TEST(OdometryIncrement, VelocitiesAreAnExactArc) {
  const OdometryIncrement model(parameters("composition"), {}, OdometrySource::kVelocities);
  MotionAction action = action_of_twist(1.5, 0.8, 0.5);
  const Eigen::Vector3d expected = action.increment;
  action.increment.setConstant(77.0);
  EXPECT_LT((move(model, {0, 0, 0}, {}, action) - expected).norm(), 1e-14);
}

TEST(OdometryIncrement, RefusesWhatItCannotDo) {
  EXPECT_THROW(OdometryIncrement(parameters("spiral"), {}), std::invalid_argument);
  EXPECT_THROW(OdometryIncrement(parameters("arc"), {}, OdometrySource::kTicks),
               std::invalid_argument);
  CalibrationParameters calibration;
  calibration.scale_left.enabled = true;
  EXPECT_THROW(OdometryIncrement(parameters("arc"), calibration), std::invalid_argument);
  const OdometryIncrement model(parameters("arc"), {});
  std::mt19937_64 random(1);
  EXPECT_THROW(model.sample(Eigen::Vector3d::Zero(), Eigen::VectorXd::Ones(1), {}, random),
               std::invalid_argument);
}

}  // namespace
}  // namespace libslam
