// Calibration of wheels and sensor by displacements of the sensor: no map.

#include <cmath>
#include <limits>
#include <random>
#include <tests/support/random_matrix.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/poses/CPose2D.h>

#include <libslam/filter/ekf_slam.hpp>
#include <libslam/measurement/sensor_displacement.hpp>
#include <libslam/motion/arc.hpp>
#include <libslam/motion/differential.hpp>
#include <libslam/state/chi_square.hpp>

using namespace libslam;
using libslam::testing::random_matrix;
using mrpt::poses::CPose2D;

namespace {

constexpr double kTrack = 0.3, kStep = 0.5;  // nominal [m], [s]
constexpr double kLeft = 1.06, kRight = 0.95, kTrackFactor = 1.08;
const Eigen::Vector3d kSensor(0.06, -0.05, 0.15);
constexpr double kSigmaXy = 1e-3, kSigmaHeading = 2e-3, kSigmaAlong = 5e-4, kSigmaTurn = 1e-3;

/// True wheel and track factors.
struct Wheels {
  double left = kLeft, right = kRight, track = kTrackFactor;
};

/// A robot with a sensor on it.
class Robot {
 public:
  explicit Robot(unsigned seed, double noise = 1.0, const Wheels& wheels = {})
      : random_(seed), noise_(noise), wheels_(wheels) {}

  /// Wheels travel by `left` and `right` [m] as they believe; returns what they report.
  MotionAction drive(double left, double right) {
    MotionAction action;
    action.dt = kStep;
    action.increment = follow_arc({0.5 * (left + right), 0.0, (right - left) / kTrack}).increment;
    const double dl = wheels_.left * left, dr = wheels_.right * right;
    const Eigen::Vector3d noise = noise_ * random_matrix(3, 1, random_);
    const Eigen::Vector3d moved =
        follow_arc({0.5 * (dl + dr) + kSigmaAlong * noise[0], 0.0,
                    (dr - dl) / (wheels_.track * kTrack) + kSigmaTurn * noise[1]})
            .increment;
    displacement_ = displacement_ + CPose2D(moved[0], moved[1], moved[2]);
    return action;
  }

  /// What the sensor says of itself: noise per displacement since the last reading.
  Feature read() {
    const CPose2D sensor(kSensor[0], kSensor[1], kSensor[2]);
    const CPose2D seen = (displacement_ + sensor) - sensor;
    const Eigen::Vector3d noise = noise_ * random_matrix(3, 1, random_);
    path_ = path_ + CPose2D(seen.x() + kSigmaXy * noise[0], seen.y() + kSigmaXy * noise[1],
                            seen.phi() + kSigmaHeading * noise[2]);
    displacement_ = {};
    Feature reading;
    reading.z = Eigen::Vector3d(path_.x(), path_.y(), path_.phi());
    reading.cov =
        Eigen::Vector3d(kSigmaXy * kSigmaXy, kSigmaXy * kSigmaXy, kSigmaHeading * kSigmaHeading)
            .asDiagonal();
    return reading;
  }

  /// The sensor's path makes a jump that the robot did not make.
  void spoil() { path_ = path_ + CPose2D(0.1, -0.05, 0.3); }

 private:
  std::mt19937_64 random_;
  double noise_;
  Wheels wheels_;
  CPose2D displacement_, path_{3.0, -2.0, 3.0};
};

EkfSlam make_filter(const char* frame, double gate = chi_square_quantile(0.99, 3)) {
  CalibrationParameters calibration;
  for (auto* parameter :
       {&calibration.scale_left, &calibration.scale_right, &calibration.track_width,
        &calibration.sensor_x, &calibration.sensor_y, &calibration.sensor_phi})
    parameter->enabled = true;
  calibration.sensor_phi.prior_sigma = 0.2;
  calibration.sensor_x.prior_sigma = calibration.sensor_y.prior_sigma = 0.1;
  MotionParameters motion;
  motion.track_width = kTrack;
  motion.noise = {};
  motion.noise.along_per_sqrt_m = motion.noise.across_per_sqrt_m = 0.0;
  motion.noise.turn_per_sqrt_m = motion.noise.turn_per_sqrt_rad = 0.0;
  motion.noise.along_per_sqrt_s = kSigmaAlong / std::sqrt(kStep);
  motion.noise.turn_per_sqrt_s = kSigmaTurn / std::sqrt(kStep);
  EkfSlamParts parts;
  parts.motion = std::make_unique<Differential>(motion, calibration);
  parts.displacement.emplace(std::make_unique<SensorDisplacement>(calibration), gate);
  parts.frame = make_error_frame(frame);
  return EkfSlam(std::move(parts));
}

/// Wheel travel of step k: straight on, turns on the spot, single wheels, curves.
Eigen::Vector2d manoeuvre(int k) {
  constexpr double kManoeuvres[][2] = {{0.08, 0.08},  {0.06, -0.06}, {0.07, 0.0},   {0.05, 0.08},
                                       {-0.06, 0.06}, {0.0, 0.07},   {-0.05, -0.08}};
  const auto& travel = kManoeuvres[(k / 5) % 7];
  return {travel[0], travel[1]};
}

struct Tally {
  int accepted = 0, gated = 0;
};

/// Drives `steps` steps, with a reading after every `per_reading`-th.
Tally calibrate(EkfSlam& filter, Robot& robot, int steps, int per_reading = 1,
                int spoil_every = 0) {
  Tally tally;
  const Feature start = robot.read();
  filter.update({&start, 1});
  for (int k = 0; k < steps; ++k) {
    const Eigen::Vector2d travel = manoeuvre(k);
    const MotionAction action = robot.drive(travel[0], travel[1]);
    filter.propagate(&action);
    if (k % per_reading != per_reading - 1) continue;
    if (spoil_every > 0 && k % spoil_every == spoil_every - 1) robot.spoil();
    const Feature reading = robot.read();
    const UpdateOutcome outcome = filter.update({&reading, 1});
    tally.accepted += outcome.accepted;
    tally.gated += outcome.gated;
  }
  return tally;
}

const Eigen::Matrix<double, 6, 1> kTruth =
    (Eigen::Matrix<double, 6, 1>() << kLeft, kRight, kTrackFactor, kSensor).finished();

/// Squared error of the six parameters in units of their joint covariance; chi-square, 6 dof.
double calibration_nees(const EkfSlam& filter) {
  Eigen::Matrix<double, 6, 1> error;
  for (Eigen::Index i = 0; i < 6; ++i)
    error[i] = filter.calibration()[static_cast<std::size_t>(i)].mean - kTruth[i];
  const Eigen::MatrixXd cov = filter.state().full_covariance().block<6, 6>(3, 3);
  return error.dot(cov.ldlt().solve(error));
}

}  // namespace

TEST(Displacement, NoiselessRunReachesTheTruth) {
  for (const char* frame : {"standard", "right_invariant"}) {
    EkfSlam filter = make_filter(frame);
    Robot robot(201, 0.0);
    const Tally tally = calibrate(filter, robot, 1500);
    EXPECT_EQ(tally.gated, 0);
    EXPECT_EQ(tally.accepted, 1500);
    for (std::size_t i = 0; i < 6; ++i) {
      const CalibrationValue value = filter.calibration()[i];
      // What is left is the nonlinearity of the first steps, weighed down by all later ones.
      EXPECT_NEAR(value.mean, kTruth[static_cast<Eigen::Index>(i)], 0.3 * value.sigma)
          << value.name << ", " << frame;
      EXPECT_TRUE(value.observable) << value.name;
    }
  }
}

TEST(Displacement, NoiselessErrorVanishesWithTheNumberOfReadings) {
  EkfSlam filter = make_filter("right_invariant");
  Robot robot(202, 0.0);
  calibrate(filter, robot, 200);
  const double early = std::abs(filter.calibration()[2].mean - kTrackFactor);
  calibrate(filter, robot, 20000);
  const double late = std::abs(filter.calibration()[2].mean - kTrackFactor);
  EXPECT_LT(late, 0.1 * early);
  EXPECT_LT(late, 1e-4);
}

// Mean of 20 runs of a chi-square of 6: the bounds hold with probability 0.999.
TEST(Displacement, CalibrationErrorsAreAsLargeAsTheFilterSays) {
  constexpr int kRuns = 20;
  for (const int per_reading : {1, 3}) {
    double sum = 0.0;
    for (unsigned run = 0; run < kRuns; ++run) {
      EkfSlam filter = make_filter("right_invariant", std::numeric_limits<double>::infinity());
      Robot robot(210 + run);
      calibrate(filter, robot, 900, per_reading);
      sum += calibration_nees(filter);
    }
    EXPECT_GT(sum, chi_square_quantile(0.0005, 6 * kRuns)) << per_reading;
    EXPECT_LT(sum, chi_square_quantile(0.9995, 6 * kRuns)) << per_reading;
  }
}

TEST(Displacement, FramesAgree) {
  EkfSlam standard = make_filter("standard"), invariant = make_filter("right_invariant");
  Robot robot(203), same(203);
  calibrate(standard, robot, 400);
  calibrate(invariant, same, 400);
  // The measurement does not see where the world is: only the retraction of second order differs.
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(standard.calibration()[i].mean, invariant.calibration()[i].mean,
                0.02 * standard.calibration()[i].sigma);
}

TEST(Displacement, FailedScanMatchesAreGatedAndHarmless) {
  EkfSlam filter = make_filter("right_invariant");
  Robot robot(204);
  const Tally tally = calibrate(filter, robot, 1000, 1, 50);
  EXPECT_GE(tally.gated, 20);       // every spoiled one
  EXPECT_LE(tally.gated, 20 + 25);  // 1 % of the others: 10 +- 3.1, 5 sigma
  EXPECT_LT(calibration_nees(filter), chi_square_quantile(0.9999, 6));
}

TEST(Displacement, StraightDriveLeavesLeverArmAndTrackUnobservable) {
  EkfSlam filter = make_filter("right_invariant");
  Robot robot(205, 1.0, {1.0, 1.0, 1.0});
  Feature reading = robot.read();
  filter.update({&reading, 1});
  for (int k = 0; k < 600; ++k) {
    const MotionAction action = robot.drive(0.08, 0.08);
    filter.propagate(&action);
    reading = robot.read();
    filter.update({&reading, 1});
  }
  const auto found = filter.calibration();
  for (const CalibrationValue& value : found) {
    const bool visible =
        value.name == "scale_left" || value.name == "scale_right" || value.name == "sensor_phi";
    EXPECT_EQ(value.observable, visible) << value.name;
  }
  EXPECT_NEAR(found[5].mean, kSensor[2], 5.0 * found[5].sigma);
}

TEST(Displacement, TheStateHoldsOneCloneOnly) {
  EkfSlam filter = make_filter("right_invariant");
  const Eigen::Index before = filter.state().dimension();
  Robot robot(206);
  calibrate(filter, robot, 30);
  EXPECT_EQ(filter.state().dimension(), before + 3);
}

TEST(Displacement, RefusesMissingParts) {
  EXPECT_THROW(DisplacementUpdate(nullptr, 1.0), std::invalid_argument);
  EkfSlamParts parts;
  parts.motion = std::make_unique<Differential>(MotionParameters{}, CalibrationParameters{});
  parts.frame = make_error_frame("standard");
  EXPECT_THROW(EkfSlam{std::move(parts)}, std::invalid_argument);
}
