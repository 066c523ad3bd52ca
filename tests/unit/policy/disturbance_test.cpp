#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <libslam/policy/disturbance.hpp>

using namespace libslam;

namespace {

DisturbanceOptions options() {
  DisturbanceOptions options;
  options.sigma = Eigen::Vector3d(3.0, 3.0, 0.35);
  return options;
}

double chi_square(std::mt19937_64& random, int dof) {
  return std::chi_squared_distribution<double>(dof)(random);
}

/// Innovations of `rows` measurements of a pose, whose error is drawn with `scale` times sigma.
JointInnovation draw(std::mt19937_64& random, Eigen::Index rows, double scale,
                     const Eigen::Vector3d& sigma) {
  std::normal_distribution<double> normal;
  const auto standard = [&](Eigen::Index n) {
    Eigen::VectorXd v(n);
    for (double& value : v) value = normal(random);
    return v;
  };
  JointInnovation joint;
  joint.wrt_pose.resize(rows, 3);
  for (Eigen::Index c = 0; c < 3; ++c) joint.wrt_pose.col(c) = standard(rows);
  const Eigen::MatrixXd noise = 0.01 * Eigen::MatrixXd::Identity(rows, rows);
  joint.cov = noise + 0.04 * joint.wrt_pose * joint.wrt_pose.transpose();
  joint.trace_noise = noise.trace();
  joint.nu = joint.cov.llt().matrixL() * standard(rows);
  joint.nu += joint.wrt_pose * scale * sigma.cwiseProduct(standard(3).head<3>());
  return joint;
}

constexpr int kHold = 3;

/// In doubt since the last update; `kHold` quiet ones in a row end it.
Disturbance disturbed() {
  DisturbanceOptions o = options();
  o.hold = kHold;
  Disturbance policy(o);
  policy.judge(100.0, 4, false);
  return policy;
}

}  // namespace

// Two tests per update, alone and in the window: false alarms lie between the probability of one
// and of both. 40 000 updates at 1e-3: 40..80 expected, 4 sigma wider allowed.
TEST(Disturbance, FalseAlarmsFollowTheTriggerProbability) {
  std::mt19937_64 random(41);
  DisturbanceOptions o = options();
  o.trigger_probability = 0.999;
  Disturbance policy(o);
  int begun = 0;
  for (int k = 0; k < 40000; ++k) {
    policy.judge(chi_square(random, 6), 6, false);
    if (policy.began()) {
      ++begun;
      policy.settle();
    }
  }
  EXPECT_GT(begun, 40 - 26);
  EXPECT_LT(begun, 80 + 36);
}

TEST(Disturbance, SeesOneLargeInnovationAtOnceAndSmallOnesInTheWindow) {
  Disturbance sudden(options());
  EXPECT_FALSE(sudden.judge(6.0, 6, false));
  EXPECT_TRUE(sudden.judge(60.0, 6, false));
  EXPECT_TRUE(sudden.began());
  Disturbance slow(options());
  int updates = 0;  // 24 of 6 degrees of freedom: .9995 each, below the trigger
  while (!slow.lasts() && updates < 10) {
    slow.judge(24.0, 6, false);
    ++updates;
  }
  EXPECT_GE(updates, 2);
  EXPECT_LE(updates, 3);
}

TEST(Disturbance, StrangersAndInnovationsThatAreNoNumbersTrigger) {
  Disturbance strangers(options());
  EXPECT_TRUE(strangers.judge(0.0, 0, true));
  Disturbance infinite(options());
  EXPECT_TRUE(infinite.judge(std::numeric_limits<double>::infinity(), 2, false));
}

TEST(Disturbance, EndsAfterQuietUpdatesInARow) {
  Disturbance policy = disturbed();
  EXPECT_FALSE(policy.judge(4.0, 4, false));
  EXPECT_FALSE(policy.began());
  EXPECT_TRUE(policy.judge(12.0, 4, false));  // beyond release, below trigger: inflate again
  for (int k = 0; k < 2; ++k) EXPECT_FALSE(policy.judge(4.0, 4, false));
  EXPECT_TRUE(policy.lasts());
  policy.judge(4.0, 4, false);
  EXPECT_FALSE(policy.lasts());
}

TEST(Disturbance, NoEvidenceIsNotQuiet) {
  Disturbance policy = disturbed();
  for (int k = 0; k < kHold; ++k) policy.judge(0.0, 0, false);
  EXPECT_TRUE(policy.lasts());
  for (int k = 0; k < kHold; ++k) {
    EXPECT_TRUE(policy.lasts());
    policy.judge(0.0, 0, false);  // between quiet ones it does not count
    policy.judge(4.0, 4, false);
  }
  EXPECT_FALSE(policy.lasts());
}

// A robot that has left its map behind has no evidence to wait for.
TEST(Disturbance, EndsAfterALongTimeWithoutEvidence) {
  Disturbance policy = disturbed();
  for (int k = 1; k < Disturbance::kBlindHolds * kHold; ++k) policy.judge(0.0, 0, false);
  EXPECT_TRUE(policy.lasts());
  policy.judge(0.0, 0, false);
  EXPECT_FALSE(policy.lasts());
}

// With many measurements of the pose the likelihood is sharp: the scale of a displacement of three
// coordinates is known within a factor, right in the median. 200 draws each.
TEST(Disturbance, MaximumLikelihoodFindsTheScale) {
  std::mt19937_64 random(42);
  const Disturbance policy(options());
  for (const double truth : {0.0, 0.1, 0.4, 1.0, 4.0}) {
    std::vector<double> scales;
    for (int k = 0; k < 200; ++k)
      scales.push_back(policy.scale(draw(random, 20, truth, options().sigma)));
    std::nth_element(scales.begin(), scales.begin() + 100, scales.end());
    if (truth == 0.0)
      EXPECT_LE(scales[100], 0.03);
    else
      EXPECT_LE(std::abs(std::log(scales[100] / truth)), std::log(2.01)) << truth;
  }
}

// The short form over the grid against the definition.
TEST(Disturbance, LikelihoodOfAScaleIsThatOfTheInflatedInnovation) {
  std::mt19937_64 random(43);
  const Disturbance policy(options());
  for (int k = 0; k < 20; ++k) {
    const JointInnovation joint = draw(random, 8, 0.5, options().sigma);
    double best = 0.0, least = std::numeric_limits<double>::infinity();
    for (const double scale : Disturbance::kScales) {
      const Eigen::MatrixXd s =
          joint.cov + joint.wrt_pose * policy.added(scale) * joint.wrt_pose.transpose();
      const double cost = joint.nu.dot(s.inverse() * joint.nu) + std::log(s.determinant());
      if (cost < least) {
        least = cost;
        best = scale;
      }
    }
    EXPECT_EQ(policy.scale(joint), best);
  }
}

TEST(Disturbance, FixedFormsDoNotLookForAScale) {
  std::mt19937_64 random(44);
  const JointInnovation joint = draw(random, 8, 3.0, options().sigma);
  DisturbanceOptions o = options();
  o.inflation = Inflation::kAdditive;
  EXPECT_EQ(Disturbance(o).scale(joint), 1.0);
  EXPECT_TRUE(
      Disturbance(o).added(1.0).isApprox(Eigen::MatrixXd(o.sigma.cwiseAbs2().asDiagonal())));
  o.inflation = Inflation::kWholeState;
  o.max_factor = 50.0;
  const double excess = joint.nu.squaredNorm() - joint.trace_noise;
  const double expected = excess / (joint.cov.trace() - joint.trace_noise);
  EXPECT_NEAR(Disturbance(o).factor(joint), std::clamp(expected, 1.0, 50.0), 1e-9);
  JointInnovation small = joint;
  small.nu *= 1e-3;
  EXPECT_EQ(Disturbance(o).factor(small), 1.0);
}

TEST(Disturbance, RefusesOptionsOutOfRange) {
  const auto refused = [](auto change) {
    DisturbanceOptions o = options();
    change(o);
    EXPECT_THROW(Disturbance{o}, std::invalid_argument);
  };
  refused([](auto& o) { o.window = 0; });
  refused([](auto& o) { o.hold = 0; });
  refused([](auto& o) { o.trigger_probability = 1.0; });
  refused([](auto& o) { o.release_probability = 0.0; });
  refused([](auto& o) { o.sigma[1] = 0.0; });
}
