// The oracle held against theory: noiseless data, the distribution of the cost, its own optimum.

#include <tests/unit/batch/batch_world.hpp>

#include <gtest/gtest.h>

#include <libslam/state/chi_square.hpp>

using namespace libslam;
using namespace libslam::testing;

namespace {

const auto kHonest = [](MotionAction&) {};

CalibrationParameters wheel_scales(double prior_sigma) {
  CalibrationParameters calibration;
  for (CalibrationParameter* scale : {&calibration.scale_left, &calibration.scale_right}) {
    scale->enabled = true;
    scale->prior_sigma = prior_sigma;
  }
  return calibration;
}

Drive plain_drive(unsigned seed, int every, double noise) {
  EkfSlam filter(batch_parts());
  return drive_world(seed, 120, every, noise, true, filter, kHonest);
}

double largest_error(const Drive& drive, const BatchEstimate& estimate) {
  double error = 0.0;
  for (std::size_t k = 0; k < drive.truth.size(); ++k) {
    const Eigen::Vector3d d = estimate.path[k] - drive.truth[k];
    error = std::max({error, d.head<2>().norm(), std::abs(wrap_angle(d[2]))});
  }
  for (std::size_t i = 0; i < drive.true_landmarks.size(); ++i)
    error = std::max(error, (estimate.landmarks[i] - drive.true_landmarks[i]).norm());
  return error;
}

/// Start values away from the truth, as a filter's would be.
BatchEstimate disturbed(BatchEstimate estimate, unsigned seed, double sigma) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  for (auto& pose : estimate.path)
    for (double& value : pose) value += normal(random);
  for (auto& landmark : estimate.landmarks)
    for (double& value : landmark) value += normal(random);
  return estimate;
}

}  // namespace

TEST(BatchOptimizer, NoiselessDataGiveTheTruthAtNoCost) {
  for (const int every : {1, 5}) {
    const EkfSlamParts parts = batch_parts();
    const Drive drive = plain_drive(311, every, 0.0);
    const BatchResult result = optimize_batch(drive.log, parts, disturbed(drive.filter, 312, 0.05));
    EXPECT_TRUE(result.converged);
    EXPECT_LT(result.chi_square, 1e-9) << every;
    EXPECT_GT(result.chi_square_before, 1e3);
    EXPECT_LT(largest_error(drive, result.estimate), 1e-6) << every;
  }
}

TEST(BatchOptimizer, NoiselessCalibrationIsFoundExactlyButForItsPrior) {
  // Wheels 4 % and -3 % off: the odometry reports what nominal wheels would have turned.
  constexpr double kLeft = 1.04, kRight = 0.97;
  const auto falsify = [](MotionAction& action) {
    const double turn = action.increment[2], half = 0.5 * turn;
    const double travel = action.increment.head<2>().norm() * half / std::sin(half);
    const double left = (travel - half * kVirtualTrack) / kLeft;
    const double right = (travel + half * kVirtualTrack) / kRight;
    const double said = (right - left) / kVirtualTrack, length = 0.5 * (left + right);
    const double chord = length * std::sin(0.5 * said) / (0.5 * said);
    action.increment = {chord * std::cos(0.5 * said), chord * std::sin(0.5 * said), said};
  };
  const CalibrationParameters calibration = wheel_scales(1e3);  // a prior that pulls by < 1e-9
  EkfSlam filter(batch_parts(wheel_scales(0.05)));
  const Drive drive = drive_world(313, 120, 3, 0.0, false, filter, falsify);
  const BatchResult result = optimize_batch(drive.log, batch_parts(calibration), drive.filter);
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.estimate.calibration[0], kLeft, 1e-6);
  EXPECT_NEAR(result.estimate.calibration[1], kRight, 1e-6);
  EXPECT_LT(largest_error(drive, result.estimate), 1e-6);
  ASSERT_EQ(result.sigma_calibration.size(), 2);
  EXPECT_GT(result.sigma_calibration.minCoeff(), 1e-4);
  EXPECT_LT(result.sigma_calibration.maxCoeff(), 0.05);
}

// The minimum of a sum of n squares of unit normals over p parameters is chi-square with n - p
// degrees of freedom; so is the sum over seeds. Two-sided test at 1e-3, seeds fixed. Measured
// power: it fails with a sigma of the sightings 3 % too small or a sigma of the motion 30 % too
// small.
TEST(BatchOptimizer, TheCostIsChiSquareDistributed) {
  for (const int every : {1, 4}) {
    double cost = 0.0;
    int dof = 0, inside = 0;
    constexpr int kSeeds = 12;
    for (unsigned seed = 320; seed < 320 + kSeeds; ++seed) {
      const EkfSlamParts parts = batch_parts();
      const Drive drive = plain_drive(seed, every, 1.0);
      const BatchResult result = optimize_batch(drive.log, parts, drive.filter);
      EXPECT_TRUE(result.converged);
      EXPECT_LE(result.chi_square, result.chi_square_before);
      std::size_t sightings = 0;
      for (const BatchStep& step : drive.log.steps) sightings += step.sightings.size();
      EXPECT_EQ(result.degrees_of_freedom,
                2 * static_cast<int>(sightings - drive.log.landmarks.size()));
      cost += result.chi_square;
      dof += result.degrees_of_freedom;
      const double p = chi_square_probability(result.chi_square, result.degrees_of_freedom);
      inside += p > 0.005 && p < 0.995;
    }
    const double p = chi_square_probability(cost, dof);
    EXPECT_GT(p, 0.5e-3) << cost << " of " << dof;
    EXPECT_LT(p, 1.0 - 0.5e-3) << cost << " of " << dof;
    EXPECT_GE(inside, kSeeds - 1);  // 99 % each; two of twelve outside: probability 0.6 %
  }
}

// One pose per step and one pose per update are the same problem to first order in the noise.
TEST(BatchOptimizer, JoinedMotionsGiveTheAnswerOfEverySingleOne) {
  const EkfSlamParts parts = batch_parts();
  const Drive drive = plain_drive(340, 6, 1.0);
  const BatchResult joined = optimize_batch(drive.log, parts, drive.filter);
  BatchLog split = drive.log;
  Feature blind;  // says nothing about a landmark of its own, but makes its step a pose
  blind.z = Eigen::Vector2d(1.0, 0.0);
  blind.cov = Eigen::Vector2d(1e6, 1e6).asDiagonal();
  BatchEstimate start = drive.filter;
  for (std::size_t k = 0; k < split.steps.size(); ++k)
    if (split.steps[k].sightings.empty()) {
      split.steps[k].sightings.push_back({split.landmarks.size(), blind});
      split.landmarks.push_back(1000 + static_cast<std::int64_t>(k));
      start.landmarks.emplace_back(start.path[k].head<2>() + Eigen::Vector2d(1.0, 0.0));
    }
  const BatchResult every = optimize_batch(split, parts, start);
  EXPECT_GT(every.poses, 5 * joined.poses);
  // Noise per update: 0.024 m and 0.012 rad; what is neglected is their product, 3e-4.
  for (std::size_t k = 0; k < drive.log.steps.size(); ++k)
    EXPECT_LT((joined.estimate.path[k] - every.estimate.path[k]).norm(), 6e-4) << k;
  for (std::size_t i = 0; i < drive.log.landmarks.size(); ++i)
    EXPECT_LT((joined.estimate.landmarks[i] - every.estimate.landmarks[i]).norm(), 6e-4) << i;
}

// Rank-deficient process noise: the drive of the world has no sideways noise at all.
TEST(BatchOptimizer, NoiseWithoutASidewaysPartIsHandled) {
  const EkfSlamParts parts = batch_parts();
  EkfSlam filter(batch_parts());
  const Drive drive = drive_world(341, 120, 1, 1.0, false, filter, kHonest);
  const BatchResult result = optimize_batch(drive.log, parts, drive.filter);
  EXPECT_TRUE(result.converged);
  EXPECT_LT(largest_error(drive, result.estimate), 0.3);
  const double p = chi_square_probability(result.chi_square, result.degrees_of_freedom);
  EXPECT_GT(p, 0.005);
  EXPECT_LT(p, 0.995);
}

// Each prior brings as many residuals as unknowns, so the degrees of freedom stay.
TEST(BatchOptimizer, AnUncertainStartAndAWalkingParameterAreUnknowns) {
  CalibrationParameters calibration = wheel_scales(0.05);
  calibration.scale_left.random_walk_per_sqrt_s = 0.01;
  EkfSlamParts parts = batch_parts(calibration);
  parts.cov_start = Eigen::Vector3d(0.1, 0.1, 0.05).cwiseAbs2().asDiagonal();
  EkfSlam filter(batch_parts(calibration));
  const Drive drive = drive_world(342, 60, 2, 1.0, true, filter, kHonest);
  const BatchResult result = optimize_batch(drive.log, parts, drive.filter);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.poses, 31);
  std::size_t sightings = 0;
  for (const BatchStep& step : drive.log.steps) sightings += step.sightings.size();
  EXPECT_EQ(result.degrees_of_freedom,
            2 * static_cast<int>(sightings - drive.log.landmarks.size()));
  // Nothing but the prior says where the world is.
  EXPECT_LT(result.estimate.start.norm(), 1e-6);
  ASSERT_EQ(result.sigma_calibration.size(), 2);
  EXPECT_LT(result.sigma_calibration[1], 0.05);
}

TEST(BatchOptimizer, RefusesWhatDoesNotFit) {
  const EkfSlamParts parts = batch_parts();
  const Drive drive = plain_drive(343, 1, 0.0);
  BatchEstimate start = drive.filter;
  start.path.pop_back();
  EXPECT_THROW(optimize_batch(drive.log, parts, start), std::invalid_argument);
  start = drive.filter;
  start.landmarks.front().resize(3);
  EXPECT_THROW(optimize_batch(drive.log, parts, start), std::invalid_argument);
  BatchLog log = drive.log;
  log.steps[3].sightings[0].landmark = log.landmarks.size();
  EXPECT_THROW(optimize_batch(log, parts, drive.filter), std::invalid_argument);
  start = drive.filter;
  start.path[5][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(optimize_batch(drive.log, parts, start), std::runtime_error);
}
