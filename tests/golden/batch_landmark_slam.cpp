#include <algorithm>
#include <ceres/ceres.h>
#include <stdexcept>
#include <tests/golden/batch_landmark_slam.hpp>

#include <Eigen/Dense>

#include <libslam/io/arc_motion.hpp>

namespace libslam::test {

namespace {

template <int N>
Eigen::Matrix<double, N, N> whitening(const Eigen::Matrix<double, N, N>& cov) {
  return Eigen::Matrix<double, N, N>(cov.inverse().llt().matrixU());
}

template <typename T>
T wrapped(const T& angle) {
  return ceres::atan2(ceres::sin(angle), ceres::cos(angle));
}

struct IncrementResidual {
  Eigen::Vector3d increment;
  Eigen::Matrix3d weight;
  template <typename T>
  bool operator()(const T* from, const T* to, T* out) const {
    const T c = ceres::cos(from[2]), s = ceres::sin(from[2]);
    const T x = to[0] - from[0], y = to[1] - from[1];
    Eigen::Map<Eigen::Matrix<T, 3, 1>> residual(out);
    residual << c * x + s * y - increment[0], -s * x + c * y - increment[1],
        wrapped(T(to[2] - from[2] - increment[2]));
    residual = weight.cast<T>() * residual;
    return true;
  }
};

struct SightingResidual {
  Eigen::Vector2d z;
  Eigen::Matrix2d weight;
  template <typename T>
  bool operator()(const T* pose, const T* landmark, T* out) const {
    const T x = landmark[0] - pose[0], y = landmark[1] - pose[1];
    Eigen::Map<Eigen::Matrix<T, 2, 1>> residual(out);
    residual << ceres::sqrt(x * x + y * y) - z[0], wrapped(T(ceres::atan2(y, x) - pose[2] - z[1]));
    residual = weight.cast<T>() * residual;
    return true;
  }
};

std::size_t row_at(const ImportedLog& log, double time) {
  const auto row =
      std::lower_bound(log.odometry.begin(), log.odometry.end(), time - 1e-6,
                       [](const ImportedOdometry& reading, double t) { return reading.time < t; });
  if (row == log.odometry.end() || row->time > time + 1e-6)
    throw std::invalid_argument("a scan stands between odometry rows");
  return static_cast<std::size_t>(row - log.odometry.begin());
}

}  // namespace

BatchEstimate optimize(const ImportedLog& log, BatchEstimate start) {
  ceres::Problem problem;
  for (std::size_t i = 1; i < log.odometry.size(); ++i) {
    const ImportedOdometry& reading = log.odometry[i];
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<IncrementResidual, 3, 3, 3>(new IncrementResidual{
            increment_of_arc(reading.arc), whitening<3>(reading.cov_increment.value())}),
        nullptr, start.poses[i - 1].data(), start.poses[i].data());
  }
  for (const ImportedScan& scan : log.scans)
    for (const ImportedSighting& sighting : scan.sightings)
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<SightingResidual, 2, 3, 2>(new SightingResidual{
              {sighting.range, sighting.bearing}, whitening<2>(sighting.cov.value())}),
          nullptr, start.poses[row_at(log, scan.time)].data(),
          start.landmarks.at(sighting.id).data());
  problem.SetParameterBlockConstant(start.poses.front().data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  start.initial_cost = summary.initial_cost;
  start.final_cost = summary.final_cost;
  start.converged = summary.termination_type == ceres::CONVERGENCE;
  return start;
}

}  // namespace libslam::test
