#pragma once
// A run made up for the tests: a robot on a figure of eight, with errors drawn from the covariance
// it claims.

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Cholesky>

#include <libslam/data/ground_truth.hpp>
#include <libslam/data/step_record.hpp>
#include <libslam/map/landmark_map.hpp>

namespace libslam::sample {

/// A fresh folder that disappears with the object.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("libslam-" + name + "-" + std::to_string(std::random_device{}()))) {
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct Run {
  std::vector<StepRecord> steps;
  LandmarkMap map;
  GroundTruth truth;
};

/// `steps` steps of 0.1 s; the first pose is known exactly, as in SLAM.
inline Run make_run(int steps, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> observed(0, 5);
  Run run;
  const auto draw = [&](Eigen::Index n) -> Eigen::VectorXd {
    return Eigen::VectorXd::NullaryExpr(n, [&] { return normal(generator); });
  };
  for (int k = 0; k < steps; ++k) {
    const double s = 0.01 * k;
    const Eigen::Vector3d truth(8 * std::sin(s), 5 * std::sin(2 * s),
                                std::atan2(10 * std::cos(2 * s), 8 * std::cos(s)));
    StepRecord step;
    step.index = k;
    step.time = 1'100'000'000.0 + 0.1 * k;
    step.pose = truth;
    if (k > 0) {
      const double grow = 1.0 + std::abs(std::sin(0.5 * s));
      Eigen::Matrix3d sqrt_cov;
      sqrt_cov << 0.05, 0, 0, 0.02, 0.04, 0, 0.004, 0.002, 0.01;
      sqrt_cov *= grow;
      step.cov = sqrt_cov * sqrt_cov.transpose();
      step.pose += sqrt_cov * draw(3);
      step.accepted = observed(generator);
      step.nis_dof = 2 * step.accepted;
      step.nis = step.nis_dof > 0 ? draw(step.nis_dof).squaredNorm() : 0.0;
    }
    const double sigma = 0.1 / std::sqrt(1.0 + 0.05 * k);
    step.calibration = {
        {"scale_left", 1.04 + sigma * std::sin(0.7 * s) / 2, sigma, 1.0, 0.1, true},
        {"scale_right", 0.98 - sigma * std::cos(0.4 * s) / 2, sigma, 1.0, 0.1, false}};
    step.step_ms = 0.2 + 0.001 * std::abs(normal(generator)) + (k % 500 == 499 ? 3.0 : 0.0);
    run.steps.push_back(step);
    run.truth.path.times.push_back(step.time);
    run.truth.path.poses.push_back(truth);
  }
  for (int i = 0; i < 24; ++i) {
    const double a = 0.2618 * i;
    const Eigen::Vector2d place(11 * std::cos(a), 8 * std::sin(a));
    const Eigen::Vector2d sigma(0.08 + 0.01 * i, 0.12);
    run.truth.landmarks.push_back({i, place});
    run.map.add({i, "point", place + sigma.cwiseProduct(Eigen::Vector2d(draw(2))),
                 sigma.cwiseAbs2().asDiagonal(), 10 + i});
  }
  run.truth.calibration = {{"scale_left", 1.04}, {"scale_right", 0.98}};
  return run;
}

}  // namespace libslam::sample
