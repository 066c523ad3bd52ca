#pragma once
// A run in space made up for the tests, with errors drawn from the covariance it claims.

#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include <libslam/result/trajectory.hpp>

#include "sample_run.hpp"

namespace libslam::sample {

inline Eigen::Quaterniond rotation(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  return angle > 0.0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector / angle))
                     : Eigen::Quaterniond::Identity();
}

/// A loop that climbs, rolls and pitches. `start_known`: the first pose has neither error nor
/// covariance, as in SLAM; else it is drawn like the others, as in a known map.
inline Run make_spatial_run(int steps, unsigned seed, bool start_known = true) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&](Eigen::Index n) -> Eigen::VectorXd {
    return Eigen::VectorXd::NullaryExpr(n, [&] { return normal(generator); });
  };
  // Lower triangular, with correlations between position and rotation.
  Eigen::Matrix<double, 6, 6> sqrt_cov = Eigen::Matrix<double, 6, 6>::Zero();
  sqrt_cov.diagonal() << 0.05, 0.04, 0.06, 0.01, 0.02, 0.015;
  sqrt_cov(3, 1) = 0.004;
  sqrt_cov(5, 0) = -0.006;
  sqrt_cov(2, 0) = 0.02;
  Run run;
  for (int k = 0; k < steps; ++k) {
    const double s = 0.01 * k;
    const SpatialPose truth{{6 * std::sin(s), 4 * std::cos(s), 1.0 + 0.5 * std::sin(3 * s)},
                            Eigen::AngleAxisd(s, Eigen::Vector3d::UnitZ()) *
                                rotation({0.3 * std::sin(2 * s), 0.2 * std::cos(s), 0.1})};
    StepRecord step;
    step.index = k;
    step.time = 1'300'000'000.0 + 0.1 * k;
    SpatialEstimate& estimate = step.spatial.emplace();
    estimate.pose = truth;
    if (k > 0 || !start_known) {
      const Eigen::VectorXd error = sqrt_cov * draw(6);
      estimate.pose.position += error.head<3>();
      estimate.pose.rotation = rotation(error.tail<3>()) * truth.rotation;
      estimate.cov = sqrt_cov * sqrt_cov.transpose();
      step.accepted = 4;
      step.nis_dof = 12;
      step.nis = draw(12).squaredNorm();
    }
    step.pose = shadow_of(estimate.pose);
    step.cov = shadow_covariance(estimate);
    step.calibration = {{"bias_x", 0.01, 0.002, 0.0, 0.1, true}};
    step.step_ms = 0.5;
    run.steps.push_back(step);
    run.truth.path.times.push_back(step.time);
    run.truth.path.spatial.push_back(truth);
    run.truth.path.poses.push_back(shadow_of(truth));
  }
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d place(8 * std::cos(0.3 * i), 6 * std::sin(0.3 * i), 0.2 * i);
    run.truth.landmarks.push_back({i, place});
    run.map.add({i, "point", place + 0.05 * Eigen::Vector3d(draw(3)),
                 0.0025 * Eigen::Matrix3d::Identity(), 7});
  }
  return run;
}

/// What the recorder would read back.
inline EstimatedPath path_of_spatial(const Run& run) {
  EstimatedPath path;
  for (const StepRecord& step : run.steps) {
    path.poses.push_back({step.index, step.time, step.pose, step.cov});
    path.spatial.push_back(*step.spatial);
  }
  return path;
}

/// The truth of `run` in another frame.
inline void move_truth(Run& run, const Eigen::Isometry3d& T) {
  for (SpatialPose& pose : run.truth.path.spatial)
    pose = {T * pose.position, Eigen::Quaterniond(T.linear()) * pose.rotation};
  for (std::size_t i = 0; i < run.truth.path.poses.size(); ++i)
    run.truth.path.poses[i] = shadow_of(run.truth.path.spatial[i]);
  for (TrueLandmark& landmark : run.truth.landmarks)
    landmark.position = T * Eigen::Vector3d(landmark.position);
}

}  // namespace libslam::sample
