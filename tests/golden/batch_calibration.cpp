#include <algorithm>
#include <array>
#include <ceres/ceres.h>
#include <cmath>
#include <stdexcept>
#include <tests/golden/batch_calibration.hpp>
#include <vector>

#include <Eigen/Geometry>

namespace libslam::test {

namespace {

constexpr std::array kNames = {"scale_left", "scale_right", "track_width",
                               "sensor_x",   "sensor_y",    "sensor_phi"};
using Values = std::array<double, 6>;
using Residuals = std::vector<Eigen::Vector3d>;

/// Measured minus predicted displacement, whitened.
struct DisplacementResidual {
  double left, right, nominal_track;  // nominal wheel travel, track [m]
  Eigen::Vector3d measured, sigma;

  template <typename T>
  bool operator()(const T* values, T* residual) const {
    const T dl = values[0] * left, dr = values[1] * right;
    const T length = 0.5 * (dl + dr), turn = (dr - dl) / (values[2] * nominal_track);
    const T half = 0.5 * turn;
    const T chord = length * (1.0 - half * half / 6.0 + half * half * half * half / 120.0);
    const Eigen::Matrix<T, 2, 1> lever(values[3], values[4]);
    const Eigen::Matrix<T, 2, 1> moved(chord * cos(half), chord * sin(half));
    const Eigen::Matrix<T, 2, 1> seen =
        Eigen::Rotation2D<T>(-values[5]) * (Eigen::Rotation2D<T>(turn) * lever + moved - lever);
    residual[0] = (measured[0] - seen.x()) / sigma[0];
    residual[1] = (measured[1] - seen.y()) / sigma[1];
    residual[2] = (measured[2] - turn) / sigma[2];
    return true;
  }
};

std::vector<DisplacementResidual> residuals_of(const ImportedLog& log, double track) {
  std::vector<DisplacementResidual> all;
  for (std::size_t i = 1; i < log.sensor_path.size(); ++i) {
    const Eigen::Vector3d &from = log.sensor_path[i - 1].pose, &to = log.sensor_path[i].pose;
    Eigen::Vector3d moved = to - from;
    moved.head<2>() = Eigen::Rotation2Dd(-from[2]) * Eigen::Vector2d((to - from).head<2>());
    moved[2] = std::remainder(moved[2], 2.0 * M_PI);
    const Eigen::Vector3d& arc = log.odometry[i].arc;
    all.push_back({arc[0] - 0.5 * track * arc[2], arc[0] + 0.5 * track * arc[2], track, moved,
                   Eigen::Vector3d(1e-3, 1e-3, 3e-3)});
  }
  return all;
}

Residuals evaluate(const std::vector<DisplacementResidual>& all, const Values& values) {
  Residuals out;
  for (DisplacementResidual one : all) {
    one.sigma.setOnes();
    one(values.data(), out.emplace_back().data());
  }
  return out;
}

Eigen::Vector3d robust_sigma(const Residuals& residuals) {
  Eigen::Vector3d sigma;
  for (Eigen::Index c = 0; c < 3; ++c) {
    std::vector<double> size;
    for (const auto& r : residuals) size.push_back(std::abs(r[c]));
    std::nth_element(size.begin(), size.begin() + static_cast<std::ptrdiff_t>(size.size() / 2),
                     size.end());
    sigma[c] = 1.4826 * size[size.size() / 2];
  }
  return sigma;
}

/// Minimizes from `values`; returns the standard deviations. Robust: with a loss that forgives
/// failed scan matches.
Values minimize(const std::vector<DisplacementResidual>& all, Values& values, bool robust) {
  ceres::Problem problem;
  for (const auto& one : all)
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<DisplacementResidual, 3, 6>(new DisplacementResidual(one)),
        robust ? new ceres::CauchyLoss(2.0) : nullptr, values.data());
  ceres::Solver::Options options;
  options.max_num_iterations = 100;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  ceres::Covariance covariance({});
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> cov;
  if (!summary.IsSolutionUsable() ||
      !covariance.Compute(std::vector<const double*>{values.data()}, &problem) ||
      !covariance.GetCovarianceBlock(values.data(), values.data(), cov.data()))
    throw std::runtime_error("batch calibration failed: " + summary.BriefReport());
  Values sigma{};
  for (std::size_t i = 0; i < sigma.size(); ++i)
    sigma[i] = std::sqrt(cov(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)));
  return sigma;
}

}  // namespace

BatchCalibration fit_calibration(const ImportedLog& log, double nominal_track,
                                 const std::map<std::string, double>& start) {
  Values values{};
  for (std::size_t i = 0; i < kNames.size(); ++i) values[i] = start.at(kNames[i]);
  std::vector<DisplacementResidual> all = residuals_of(log, nominal_track);
  minimize(all, values, true);
  const Residuals residuals = evaluate(all, values);
  const Eigen::Vector3d sigma = robust_sigma(residuals);
  std::vector<DisplacementResidual> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if ((residuals[i].cwiseAbs().array() > 4.0 * sigma.array()).any()) continue;
    all[i].sigma = sigma;
    kept.push_back(all[i]);
  }
  const Values deviation = minimize(kept, values, false);
  BatchCalibration result;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    result.mean[kNames[i]] = values[i];
    result.sigma[kNames[i]] = deviation[i];
  }
  result.trimmed = 1.0 - static_cast<double>(kept.size()) / static_cast<double>(all.size());
  return result;
}

}  // namespace libslam::test
