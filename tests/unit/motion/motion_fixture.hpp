#pragma once
// What every motion model is put through: a state with its blocks, Jacobians, moments.

#include <cmath>
#include <random>
#include <string>
#include <support/numeric_jacobian.hpp>
#include <vector>

#include <gtest/gtest.h>

#include <libslam/motion/motion_model.hpp>

namespace libslam::testing {

inline const BlockSpec kPoseSpec{"pose", Chart::kSE2, 3, WorldRole::kPose};

/// A state with a pose and the calibration blocks of a model, at given values.
struct MotionState {
  MotionState(const MotionModel& model, const Eigen::Vector3d& pose_value,
              const Eigen::VectorXd& calibration) {
    pose = state.add(kPoseSpec, pose_value, Eigen::Matrix3d::Identity());
    for (std::size_t i = 0; i < model.calibration().size(); ++i) {
      const CalibrationSpec& spec = model.calibration()[i];
      blocks.push_back(state.add({spec.name, Chart::kVector, 1, WorldRole::kNone},
                                 calibration.segment<1>(static_cast<Eigen::Index>(i)),
                                 Eigen::MatrixXd::Constant(1, 1, spec.prior_sigma)));
    }
  }

  MotionStep step(const MotionModel& model, const MotionAction& action) const {
    MotionStep result;
    model.linearize(state, pose, blocks, action, result);
    return result;
  }

  GaussianState state;
  BlockId pose;
  CalibrationBlocks blocks;
};

/// The prior means of a model.
inline Eigen::VectorXd priors_of(const MotionModel& model) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(model.calibration().size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values[i] = model.calibration()[static_cast<std::size_t>(i)].prior_mean;
  }
  return values;
}

inline Eigen::Vector3d move(const MotionModel& model, const Eigen::Vector3d& pose,
                            const Eigen::VectorXd& calibration, const MotionAction& action) {
  return MotionState(model, pose, calibration).step(model, action).estimate;
}

/// Column of a calibration parameter by name.
inline Eigen::Vector3d column_of(const MotionModel& model, const MotionStep& step,
                                 const std::string& name) {
  for (std::size_t i = 0; i < model.calibration().size(); ++i) {
    if (model.calibration()[i].name == name) return (step.wrt.begin() + 1 + i)->jacobian;
  }
  throw std::out_of_range(name);
}

/// Poses and increments by regime: zero, tiny, ordinary, headings and turns near pi.
inline std::vector<Eigen::Vector3d> poses_by_regime() {
  return {{0, 0, 0}, {1, -2, 1e-8}, {-3, 4, 2.0}, {5, 1, M_PI - 1e-9}, {2, 2, -M_PI + 1e-9}};
}

inline std::vector<Eigen::Vector3d> increments_by_regime() {
  return {{0, 0, 0},           {1e-8, 1e-9, 1e-8}, {0.3, 0.02, 0.1},
          {0.3, 0, 0},         {-0.4, 0.05, -0.2}, {0.2, -0.01, 9.9e-4},
          {0.2, 0.1, -1.1e-3}, {0.1, 0.3, 3.1},    {0.05, -0.2, -3.1}};
}

/// Every Jacobian of `linearize` against central differences (bound: numeric_jacobian.hpp).
inline void expect_jacobians(const MotionModel& model, const Eigen::Vector3d& pose,
                             const Eigen::VectorXd& calibration, const MotionAction& action) {
  const MotionState at(model, pose, calibration);
  const MotionStep step = at.step(model, action);
  ASSERT_EQ(step.wrt.size(), static_cast<int>(1 + at.blocks.size()));
  EXPECT_EQ(step.target, at.pose);
  const auto f = [&](const GaussianState& state) {
    MotionStep moved;
    model.linearize(state, at.pose, at.blocks, action, moved);
    return Eigen::VectorXd(moved.estimate);
  };
  for (const BlockJacobian& entry : step.wrt) {
    const Eigen::MatrixXd numeric = numeric_jacobian(at.state, entry.block, f, kPoseSpec);
    const double scale = 1.0 + numeric.cwiseAbs().maxCoeff();
    EXPECT_LT((entry.jacobian - numeric).cwiseAbs().maxCoeff(), 1e-8 * scale)
        << at.state.spec(entry.block).name << "\nanalytic\n"
        << entry.jacobian << "\nnumeric\n"
        << numeric << "\npose " << pose.transpose() << " increment "
        << action.increment.transpose();
  }
}

/// Mean and covariance of samples against the linearization. With n samples a mean scatters by
/// sigma / sqrt(n) and a covariance entry by at most sqrt(2 / n) sigma_i sigma_j; five of these
/// are allowed. The noise must be small enough that second-order terms, sigma^2, stay below.
inline void expect_moments(const MotionModel& model, const Eigen::Vector3d& pose,
                           const Eigen::VectorXd& calibration, const MotionAction& action,
                           std::uint64_t seed) {
  constexpr int kSamples = 20000;
  const MotionStep step = MotionState(model, pose, calibration).step(model, action);
  std::mt19937_64 random(seed);
  Eigen::MatrixX3d errors(kSamples, 3);
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector3d sample = model.sample(pose, calibration, action, random);
    errors.row(i) = boxminus(kPoseSpec, sample, Eigen::Vector3d(step.estimate)).transpose();
  }
  const Eigen::RowVector3d mean = errors.colwise().mean();
  errors.rowwise() -= mean;
  const Eigen::Matrix3d cov = errors.transpose() * errors / (kSamples - 1);
  const Eigen::Matrix3d expected = step.cov_noise;
  const Eigen::Vector3d sigma = expected.diagonal().cwiseSqrt();
  for (int i = 0; i < 3; ++i) {
    EXPECT_LE(std::abs(mean[i]), 5.0 * sigma[i] / std::sqrt(kSamples) + 1e-12) << "mean " << i;
    for (int j = 0; j < 3; ++j) {
      EXPECT_LE(std::abs(cov(i, j) - expected(i, j)),
                5.0 * std::sqrt(2.0 / kSamples) * sigma[i] * sigma[j] + 1e-15)
          << "covariance " << i << ' ' << j << "\nsampled\n"
          << cov << "\nlinearized\n"
          << expected;
    }
  }
}

/// Small noise of every kind.
inline OdometryNoiseParameters small_noise() {
  OdometryNoiseParameters noise;
  noise.along_per_sqrt_s = 4e-4;
  noise.along_per_sqrt_m = 1e-3;
  noise.along_per_sqrt_rad = 5e-4;
  noise.across_per_sqrt_s = 2e-4;
  noise.across_per_sqrt_m = 6e-4;
  noise.turn_per_sqrt_s = 3e-4;
  noise.turn_per_sqrt_m = 1e-3;
  noise.turn_per_sqrt_rad = 2e-3;
  noise.steering_per_sqrt_s = 5e-4;
  return noise;
}

inline MotionAction action_of(const Eigen::Vector3d& increment, double dt = 0.1) {
  MotionAction action;
  action.dt = dt;
  action.increment = increment;
  return action;
}

/// A constant twist (v, omega) given both as velocities and as the increment that it makes.
inline MotionAction action_of_twist(double v, double omega, double dt) {
  MotionAction action;
  action.dt = dt;
  action.velocity = Eigen::Vector2d(v, omega);
  const double turn = omega * dt;
  if (omega == 0.0) {
    action.increment = {v * dt, 0.0, 0.0};
  } else {
    action.increment = {v / omega * std::sin(turn), v / omega * (1.0 - std::cos(turn)), turn};
  }
  return action;
}

/// Fourth-order Runge-Kutta of pose' = rate(pose) over `dt` in `steps` steps; heading not wrapped.
template <class Rate>
Eigen::Vector3d integrate(Eigen::Vector3d pose, double dt, int steps, const Rate& rate) {
  const double h = dt / steps;
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector3d k1 = rate(pose);
    const Eigen::Vector3d k2 = rate(pose + 0.5 * h * k1);
    const Eigen::Vector3d k3 = rate(pose + 0.5 * h * k2);
    const Eigen::Vector3d k4 = rate(pose + h * k3);
    pose += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return pose;
}

}  // namespace libslam::testing
