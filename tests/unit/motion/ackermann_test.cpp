#include <libslam/motion/ackermann.hpp>
#include <libslam/motion/odometry_increment.hpp>

#include "motion_fixture.hpp"

namespace libslam {
namespace {

using namespace testing;

const std::vector<std::string> kForms{"rear_axle", "front_axle", "seed"};

MotionParameters parameters(const std::string& form, double encoder_offset = 0.76) {
  MotionParameters motion;
  motion.wheelbase = 2.83;
  motion.encoder_offset = encoder_offset;
  motion.ackermann_form = form;
  motion.metres_per_tick_left = 1e-3;
  motion.metres_per_tick_right = 1.1e-3;
  motion.noise = small_noise();
  return motion;
}

CalibrationParameters speed_on() {
  CalibrationParameters calibration;
  calibration.scale_speed.enabled = calibration.scale_steering.enabled = true;
  calibration.bias_steering.enabled = true;
  return calibration;
}

CalibrationParameters wheels_on() {
  CalibrationParameters calibration;
  calibration.scale_left.enabled = calibration.scale_right.enabled = true;
  calibration.scale_steering.enabled = calibration.bias_steering.enabled = true;
  return calibration;
}

const Eigen::Vector3d kTrue(1.03, 1.06, -0.02);  // speed, steering, bias

/// Log of a vehicle at speed `v` and steering `gamma` with nominal calibration.
MotionAction drive(double v, double gamma, double dt, double wheelbase = 2.83) {
  return action_of_twist(v, v * std::tan(gamma) / wheelbase, dt);
}

TEST(Ackermann, JacobiansByRegime) {
  for (const auto& form : kForms) {
    for (const double offset : {0.0, 0.76, -0.5}) {
      const Ackermann model(parameters(form, offset), speed_on(), OdometrySource::kVelocities);
      for (const auto& pose : poses_by_regime()) {
        for (const double gamma : {0.0, 1e-8, 0.3, -0.6}) {
          for (const double v : {0.0, 1e-7, 3.0, -2.0}) {
            expect_jacobians(model, pose, Eigen::Vector3d(1, 1, 0), drive(v, gamma, 0.2));
            expect_jacobians(model, pose, kTrue, drive(v, gamma, 0.2));
          }
        }
      }
    }
  }
}

TEST(Ackermann, JacobiansWithTwoWheelsOfTicks) {
  for (const auto& form : kForms) {
    const Ackermann model(parameters(form, 0.0), wheels_on(), OdometrySource::kTicks);
    MotionAction action = drive(3.0, 0.2, 0.1);
    action.ticks = Eigen::Vector2d(290, 280);
    expect_jacobians(model, {1, 2, 3}, Eigen::Vector4d(1.02, 0.97, 1.06, -0.02), action);
  }
}

TEST(Ackermann, SpeedAndSteeringNoiseHaveTheirJacobians) {
  // One noise input at a time: its column is the square root of the covariance it leaves behind.
  for (const auto& form : kForms) {
    MotionParameters motion = parameters(form);
    const MotionAction action = drive(3.0, 0.3, 0.2);
    const Ackermann model(motion, speed_on(), OdometrySource::kVelocities);
    const Eigen::Vector3d pose(1, 2, 3);
    const MotionStep at = MotionState(model, pose, kTrue).step(model, action);

    motion.noise = {};
    motion.noise.along_per_sqrt_m = motion.noise.across_per_sqrt_m = 0.0;
    motion.noise.turn_per_sqrt_m = motion.noise.turn_per_sqrt_rad = 0.0;
    motion.noise.steering_per_sqrt_s = 0.01;
    const Ackermann steered(motion, speed_on(), OdometrySource::kVelocities);
    // Steering noise acts like the bias: same column.
    const Eigen::Vector3d bias = column_of(model, at, "bias_steering");
    const Eigen::Matrix3d by_steering = bias * bias.transpose() * (0.01 * 0.01 / 0.2);
    EXPECT_TRUE(MotionState(steered, pose, kTrue)
                    .step(steered, action)
                    .cov_noise.isApprox(by_steering, 1e-12));

    motion.noise.steering_per_sqrt_s = 0.0;
    motion.noise.along_per_sqrt_s = 0.1;
    const Ackermann pushed(motion, speed_on(), OdometrySource::kVelocities);
    // Distance noise acts like the speed scale, whose column is that of s times s / scale.
    const double gamma = kTrue[1] * 0.3 + kTrue[2];
    const double h = motion.encoder_offset / motion.wheelbase;
    const double s = kTrue[0] * 0.6 * (1 - h * std::tan(0.3)) / (1 - h * std::tan(gamma));
    const Eigen::Vector3d by_s = column_of(model, at, "scale_speed") * (kTrue[0] / s);
    EXPECT_TRUE(MotionState(pushed, pose, kTrue)
                    .step(pushed, action)
                    .cov_noise.isApprox(by_s * by_s.transpose() * (0.1 * 0.1 * 0.2), 1e-12));
  }
}

/// Pose after driving 200 random steps with the true calibration, by the continuous model.
struct Trial {
  Eigen::Vector3d truth{1, 2, 3}, by_velocities{1, 2, 3}, by_increments{1, 2, 3};
  double path = 0.0;
};

Trial run_trial(const std::string& form) {
  const MotionParameters motion = parameters(form);
  const double wheelbase = motion.wheelbase, h = motion.encoder_offset / wheelbase;
  const Ackermann velocities(motion, speed_on(), OdometrySource::kVelocities);
  const Ackermann increments(motion, speed_on());
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> speed(-2.0, 5.0), steering(-0.6, 0.6);
  const double dt = 0.2;
  Trial trial;
  for (int k = 0; k < 200; ++k) {
    // What encoder and steering sensor say, and what is true.
    const double encoder = k % 20 == 0 ? 0.0 : speed(random);
    const double gamma = k % 10 == 0 ? 0.0 : steering(random);
    const double v_nominal = encoder / (1.0 - h * std::tan(gamma));
    const double true_gamma = kTrue[1] * gamma + kTrue[2];
    const double v = kTrue[0] * encoder / (1.0 - h * std::tan(true_gamma));
    const double omega = v * std::tan(true_gamma) / wheelbase;
    const bool front = form == "front_axle";
    const double reference_speed = front ? v / std::cos(true_gamma) : v;
    const double heading = front ? true_gamma : 0.0;
    trial.truth = integrate(trial.truth, dt, 200, [&](const Eigen::Vector3d& pose) {
      return Eigen::Vector3d(reference_speed * std::cos(pose.z() + heading),
                             reference_speed * std::sin(pose.z() + heading), omega);
    });
    trial.path += std::abs(reference_speed) * dt;
    const MotionAction action = drive(v_nominal, gamma, dt);
    trial.by_velocities = move(velocities, trial.by_velocities, kTrue, action);
    trial.by_increments = move(increments, trial.by_increments, kTrue, action);
  }
  return trial;
}

TEST(Ackermann, DeadReckoningEqualsFineIntegration) {
  for (const char* form : {"rear_axle", "front_axle"}) {
    const Trial trial = run_trial(form);
    EXPECT_LT(boxminus(kPoseSpec, trial.by_velocities, trial.truth).norm(), 1e-9 * trial.path);
    EXPECT_LT(boxminus(kPoseSpec, trial.by_increments, trial.truth).norm(), 1e-9 * trial.path);
  }
}

TEST(Ackermann, SeedFormIsEquationS14) {
  const Ackermann model(parameters("seed", 0.0), speed_on(), OdometrySource::kVelocities);
  const double v = 3.0, gamma = 0.25, dt = 0.025, theta = 0.7;
  const double true_v = kTrue[0] * v, true_gamma = kTrue[1] * gamma + kTrue[2];
  const Eigen::Vector3d expected(1.0 + true_v * dt * std::cos(theta + true_gamma),
                                 2.0 + true_v * dt * std::sin(theta + true_gamma),
                                 theta + true_v * dt * std::tan(true_gamma) / 2.83);
  EXPECT_LT((move(model, {1, 2, theta}, kTrue, drive(v, gamma, dt)) - expected).norm(), 1e-14);
}

TEST(Ackermann, UnitFactorsReproduceTheLoggedIncrements) {
  for (const auto& form : kForms) {
    const Ackermann model(parameters(form), speed_on());
    for (const double v : {3.0, -2.0, 0.0}) {
      for (const double gamma : {0.0, 0.3, -0.7}) {
        // A log of the reference point of this very form.
        const Ackermann writer(parameters(form), {}, OdometrySource::kVelocities);
        const Eigen::Vector3d logged = move(writer, {0, 0, 0}, {}, drive(v, gamma, 0.2));
        const Eigen::Vector3d read =
            move(model, {0, 0, 0}, priors_of(model), action_of(logged, 0.2));
        EXPECT_LT((read - logged).norm(), 1e-14) << form << ' ' << v << ' ' << gamma;
      }
    }
  }
}

TEST(Ackermann, EqualWheelSpeedsShowOnlyTheSumOfTheScales) {
  for (const auto& form : kForms) {
    const Ackermann model(parameters(form), wheels_on());
    const Eigen::Vector4d values(1.02, 0.97, 1.06, -0.02);
    const MotionStep step = MotionState(model, {1, 2, 3}, values).step(model, drive(3.0, 0.3, 0.2));
    EXPECT_EQ(column_of(model, step, "scale_left"), column_of(model, step, "scale_right"));
    EXPECT_GT(column_of(model, step, "scale_left").norm(), 0.1);
  }
}

TEST(Ackermann, StandstillIsNoMotion) {
  for (const auto& form : kForms) {
    const Ackermann model(parameters(form), speed_on());
    const MotionAction action = action_of({0, 0, 0.01});  // jitter of the heading
    const MotionStep step = MotionState(model, {1, 2, 3}, kTrue).step(model, action);
    EXPECT_EQ(step.estimate, Eigen::Vector3d(1, 2, 3));
    for (const char* name : {"scale_speed", "scale_steering", "bias_steering"}) {
      EXPECT_EQ(column_of(model, step, name), Eigen::Vector3d::Zero()) << name;
    }
    EXPECT_GT(step.cov_noise.diagonal().minCoeff(), 0.0);  // of the time parts
  }
}

TEST(Ackermann, SteeringIsClampedBeforeThePole) {
  for (const auto& form : kForms) {
    const Ackermann model(parameters(form), speed_on());
    EXPECT_NEAR(std::tan(model.steering_limit()) * 0.76 / 2.83, 0.75, 1e-12);
    // A creeping vehicle whose heading jitters: finite, with bounded derivatives.
    const MotionAction action = action_of({1e-6, 0, 0.02});
    const MotionStep step =
        MotionState(model, {0, 0, 0}, Eigen::Vector3d(1, 1.2, 0)).step(model, action);
    EXPECT_LT(step.estimate.norm(), 1e-5);
    EXPECT_EQ(column_of(model, step, "scale_steering"), Eigen::Vector3d::Zero());
    EXPECT_LT(column_of(model, step, "scale_speed").norm(), 1e-5);
  }
}

TEST(Ackermann, DisabledParametersAreConstants) {
  CalibrationParameters off;
  off.scale_speed.prior_mean = kTrue[0];
  off.scale_steering.prior_mean = kTrue[1];
  off.bias_steering.prior_mean = kTrue[2];
  for (const auto& form : kForms) {
    const Ackermann constant(parameters(form), off), estimated(parameters(form), speed_on());
    const MotionAction action = drive(3.0, 0.3, 0.2);
    EXPECT_TRUE(constant.calibration().empty());
    EXPECT_EQ(move(constant, {1, 2, 3}, {}, action), move(estimated, {1, 2, 3}, kTrue, action));
  }
}

TEST(Ackermann, SamplesFollowTheLinearization) {
  for (const auto& form : kForms) {
    const Ackermann model(parameters(form), speed_on());
    MotionAction action = drive(3.0, 0.3, 0.2);
    expect_moments(model, {1, 2, 3}, kTrue, action, 8);
    action.cov_increment = Eigen::Vector3d(1e-6, 2e-6, 3e-6).asDiagonal();
    expect_moments(model, {1, 2, 3}, kTrue, action, 9);
  }
}

TEST(Ackermann, RefusesWhatItCannotDo) {
  MotionParameters motion = parameters("middle");
  EXPECT_THROW(Ackermann(motion, {}), std::invalid_argument);
  motion = parameters("seed");
  motion.wheelbase = -1.0;
  EXPECT_THROW(Ackermann(motion, {}), std::invalid_argument);
  EXPECT_THROW(Ackermann(parameters("seed"), {}, OdometrySource::kTicks), std::invalid_argument);
  CalibrationParameters both = speed_on();
  both.scale_left.enabled = true;
  EXPECT_THROW(Ackermann(parameters("seed"), both), std::invalid_argument);
  CalibrationParameters track;
  track.track_width.enabled = true;
  EXPECT_THROW(Ackermann(parameters("seed"), track), std::invalid_argument);
}

}  // namespace
}  // namespace libslam
