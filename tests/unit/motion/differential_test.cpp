#include <libslam/motion/differential.hpp>
#include <libslam/motion/odometry_increment.hpp>

#include "motion_fixture.hpp"

namespace libslam {
namespace {

using namespace testing;

MotionParameters parameters() {
  MotionParameters motion;
  motion.track_width = 0.4;
  motion.metres_per_tick_left = 1e-3;
  motion.metres_per_tick_right = 1.1e-3;
  motion.noise = small_noise();
  return motion;
}

CalibrationParameters all_on() {
  CalibrationParameters calibration;
  calibration.scale_left.enabled = calibration.scale_right.enabled = true;
  calibration.track_width.enabled = true;
  return calibration;
}

const Eigen::Vector3d kTrue(1.04, 0.97, 1.1);

TEST(Differential, JacobiansByRegime) {
  const Differential model(parameters(), all_on());
  for (const auto& pose : poses_by_regime()) {
    for (const auto& increment : increments_by_regime()) {
      expect_jacobians(model, pose, Eigen::Vector3d::Ones(), action_of(increment));
      expect_jacobians(model, pose, kTrue, action_of(increment));
    }
  }
}

TEST(Differential, JacobiansForTicks) {
  const Differential model(parameters(), all_on(), OdometrySource::kTicks);
  for (const Eigen::Vector2d& ticks : {Eigen::Vector2d(0, 0), Eigen::Vector2d(120, 100),
                                       Eigen::Vector2d(-300, 280), Eigen::Vector2d(-50, -50)}) {
    MotionAction action = action_of({0, 0, 0});
    action.ticks = ticks;
    expect_jacobians(model, {1, 2, 3}, kTrue, action);
  }
}

TEST(Differential, UnitFactorsAreThePlainComposition) {
  const Differential model(parameters(), all_on());
  const OdometryIncrement composition(parameters(), {});
  for (const auto& pose : poses_by_regime()) {
    for (const auto& increment : increments_by_regime()) {
      MotionAction action = action_of(increment);
      action.cov_increment = Eigen::Vector3d(1e-3, 2e-3, 3e-3).asDiagonal();
      const MotionStep a = MotionState(model, pose, priors_of(model)).step(model, action);
      const MotionStep b = MotionState(composition, pose, {}).step(composition, action);
      EXPECT_LT(boxminus(kPoseSpec, a.estimate, b.estimate).norm(), 1e-14);
      EXPECT_EQ(a.cov_noise, b.cov_noise);
    }
  }
}

TEST(Differential, DeadReckoningEqualsFineIntegration) {
  // The encoders over- and under-count by the true factors; the truth is the continuous model.
  const MotionParameters motion = parameters();
  const Differential from_velocities(motion, all_on(), OdometrySource::kVelocities);
  const Differential from_increments(motion, all_on());
  const Differential from_ticks(motion, all_on(), OdometrySource::kTicks);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> speed(-1.0, 2.0), turning(-3.0, 3.0);
  const double dt = 0.25;
  Eigen::Vector3d truth(1, 2, 3), a = truth, b = truth, c = truth;
  double path = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double v = speed(random);
    const double omega = k % 10 == 0 ? 0.0 : turning(random);
    const double left = v - 0.5 * omega * motion.track_width;
    const double right = v + 0.5 * omega * motion.track_width;
    const double true_v = 0.5 * (kTrue[0] * left + kTrue[1] * right);
    const double true_omega =
        (kTrue[1] * right - kTrue[0] * left) / (motion.track_width * kTrue[2]);
    truth = integrate(truth, dt, 200, [&](const Eigen::Vector3d& pose) {
      return Eigen::Vector3d(true_v * std::cos(pose.z()), true_v * std::sin(pose.z()), true_omega);
    });
    path += std::abs(true_v) * dt;
    MotionAction action = action_of_twist(v, omega, dt);
    action.ticks = Eigen::Vector2d(left * dt / motion.metres_per_tick_left,
                                   right * dt / motion.metres_per_tick_right);
    a = move(from_velocities, a, kTrue, action);
    b = move(from_increments, b, kTrue, action);
    c = move(from_ticks, c, kTrue, action);
  }
  for (const auto& pose : {a, b, c}) {
    EXPECT_LT(boxminus(kPoseSpec, pose, truth).norm(), 1e-9 * path);
  }
}

TEST(Differential, DisabledParametersAreConstants) {
  CalibrationParameters off;
  off.scale_left.prior_mean = kTrue[0];
  off.scale_right.prior_mean = kTrue[1];
  off.track_width.prior_mean = kTrue[2];
  const Differential constant(parameters(), off), estimated(parameters(), all_on());
  const MotionAction action = action_of({0.3, 0.02, 0.2});
  EXPECT_TRUE(constant.calibration().empty());
  EXPECT_EQ(move(constant, {1, 2, 3}, {}, action), move(estimated, {1, 2, 3}, kTrue, action));
}

TEST(Differential, TrackWidthIsUnobservableOnAStraightLine) {
  const Differential model(parameters(), all_on());
  const MotionState at(model, {1, 2, 3}, priors_of(model));
  const MotionStep straight = at.step(model, action_of({0.5, 0, 0}));
  EXPECT_EQ(column_of(model, straight, "track_width"), Eigen::Vector3d::Zero());
  EXPECT_GT(column_of(model, straight, "scale_left").norm(), 0.1);
  const MotionStep still = at.step(model, action_of({0, 0, 0}));
  for (const char* name : {"scale_left", "scale_right", "track_width"}) {
    EXPECT_EQ(column_of(model, still, name), Eigen::Vector3d::Zero()) << name;
  }
  const MotionStep turn = at.step(model, action_of({0.5, 0, 0.3}));
  EXPECT_GT(column_of(model, turn, "track_width").norm(), 0.1);
}

TEST(Differential, SamplesFollowTheLinearization) {
  const Differential model(parameters(), all_on());
  MotionAction action = action_of({0.5, 0.1, 0.4});
  expect_moments(model, {1, 2, 3}, kTrue, action, 4);
  action.cov_increment = Eigen::Vector3d(1e-6, 2e-6, 3e-6).asDiagonal();
  expect_moments(model, {1, 2, 3}, kTrue, action, 5);
}

TEST(Differential, RefusesWhatItCannotDo) {
  MotionParameters motion = parameters();
  motion.track_width = 0.0;
  EXPECT_THROW(Differential(motion, {}), std::invalid_argument);
  motion = parameters();
  motion.metres_per_tick_left = 0.0;
  EXPECT_THROW(Differential(motion, {}, OdometrySource::kTicks), std::invalid_argument);
  CalibrationParameters calibration;
  calibration.bias_steering.enabled = true;
  EXPECT_THROW(Differential(parameters(), calibration), std::invalid_argument);
  const Differential model(parameters(), {}, OdometrySource::kTicks);
  EXPECT_THROW(move(model, {0, 0, 0}, {}, action_of({0.1, 0, 0})), std::invalid_argument);
}

}  // namespace
}  // namespace libslam
