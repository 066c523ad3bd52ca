// Where nothing is non-linear, every error frame and point of linearization is the same Kalman
// filter, and that is the weighted least-squares solution.

#include <limits>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/association/known.hpp>
#include <libslam/filter/ekf_slam.hpp>
#include <libslam/motion/odometry_increment.hpp>

using namespace libslam;

namespace {

/// z = m - p in world axes, as with a perfect compass: linear in the state.
class WorldDifference final : public MeasurementModel {
 public:
  BlockSpec landmark_spec() const override { return {"", Chart::kVector, 2, WorldRole::kPoint}; }
  MeasurementVector predict(const GaussianState& state, BlockId pose, BlockId landmark,
                            const Feature&) const override {
    return state.estimate(landmark) - state.estimate(pose).head<2>();
  }
  void linearize(const GaussianState& state, BlockId pose, BlockId landmark, const Feature& feature,
                 LinearizedMeasurement& out) const override {
    out.innovation = feature.z - predict(state, pose, landmark, feature);
    out.cov = feature.cov;
    out.wrt.clear();
    out.wrt.add(pose, 2, 3).leftCols<2>() = -Eigen::Matrix2d::Identity();
    out.wrt.add(landmark, 2, 2) = Eigen::Matrix2d::Identity();
  }
  void initialize(const GaussianState& state, BlockId pose, const Feature& feature,
                  Initialization& out) const override {
    out.estimate = state.estimate(pose).head<2>() + feature.z;
    out.wrt.clear();
    out.wrt.add(pose, 2, 3).leftCols<2>() = Eigen::Matrix2d::Identity();
    out.cov_noise = feature.cov;
  }
};

constexpr int kLandmarks = 4, kSteps = 12;
constexpr double kSigmaMotion = 0.2, kSigmaSighting = 0.3;

/// Motions along world axes and the differences seen after each, all with noise.
struct Problem {
  std::vector<Eigen::Vector2d> motions;
  std::vector<std::vector<Eigen::Vector2d>> sightings;
};

Problem make_problem(unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto noise = [&](double sigma) {
    const double x = normal(random);
    return Eigen::Vector2d(sigma * Eigen::Vector2d(x, normal(random)));
  };
  std::vector<Eigen::Vector2d> landmarks(kLandmarks);
  for (auto& landmark : landmarks) landmark = noise(10.0);
  Problem problem;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  for (int k = 0; k < kSteps; ++k) {
    const Eigen::Vector2d motion = noise(1.0);
    position += motion;
    problem.motions.push_back(motion + noise(kSigmaMotion));
    auto& seen = problem.sightings.emplace_back();
    for (const auto& landmark : landmarks)
      seen.push_back(landmark - position + noise(kSigmaSighting));
  }
  return problem;
}

Eigen::VectorXd run_filter(const Problem& problem, const char* frame, bool first_estimates) {
  EkfSlamParts parts;
  parts.motion = std::make_unique<OdometryIncrement>(MotionParameters{}, CalibrationParameters{});
  parts.measurement = std::make_unique<WorldDifference>();
  parts.associator = std::make_unique<KnownAssociation>(std::numeric_limits<double>::infinity());
  parts.frame = make_error_frame(frame);
  if (first_estimates) parts.linearization = std::make_unique<FirstEstimates>();
  EkfSlam filter(std::move(parts));
  for (int k = 0; k < kSteps; ++k) {
    MotionAction action;
    const auto step = static_cast<std::size_t>(k);
    action.increment << problem.motions[step], 0.0;
    action.cov_increment = Eigen::Vector3d(1, 1, 0).asDiagonal() * kSigmaMotion * kSigmaMotion;
    filter.propagate(&action);
    std::vector<Feature> features(kLandmarks);
    for (std::size_t i = 0; i < kLandmarks; ++i) {
      features[i].id = static_cast<std::int64_t>(i);
      features[i].z = problem.sightings[step][i];
      features[i].cov = Eigen::Matrix2d::Identity() * kSigmaSighting * kSigmaSighting;
    }
    filter.update(features);
  }
  Eigen::VectorXd result(2 + 2 * kLandmarks);
  result.head<2>() = filter.state().estimate(filter.pose()).head<2>();
  for (int i = 0; i < kLandmarks; ++i)
    result.segment<2>(2 + 2 * i) = filter.landmarks()[static_cast<std::size_t>(i)].mean;
  return result;
}

/// Last position and landmarks by normal equations over all positions; x and y do not mix.
Eigen::VectorXd solve_batch(const Problem& problem) {
  const Eigen::Index unknowns = kSteps + kLandmarks;
  Eigen::VectorXd result(2 + 2 * kLandmarks);
  for (const int axis : {0, 1}) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(kSteps * (1 + kLandmarks), unknowns);
    Eigen::VectorXd b(a.rows());
    Eigen::Index row = 0;
    for (int k = 0; k < kSteps; ++k) {
      a(row, k) = 1.0 / kSigmaMotion;
      if (k > 0) a(row, k - 1) = -1.0 / kSigmaMotion;
      b[row++] = problem.motions[static_cast<std::size_t>(k)][axis] / kSigmaMotion;
      for (int i = 0; i < kLandmarks; ++i) {
        a(row, kSteps + i) = 1.0 / kSigmaSighting;
        a(row, k) = -1.0 / kSigmaSighting;
        b[row++] =
            problem.sightings[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)][axis] /
            kSigmaSighting;
      }
    }
    const Eigen::VectorXd x = a.colPivHouseholderQr().solve(b);
    result[axis] = x[kSteps - 1];
    for (int i = 0; i < kLandmarks; ++i) result[2 + 2 * i + axis] = x[kSteps + i];
  }
  return result;
}

}  // namespace

RC_GTEST_PROP(LinearProblem, EveryFilterIsTheLeastSquaresSolution, ()) {
  const Problem problem = make_problem(*rc::gen::inRange(0u, 1'000'000u));
  const Eigen::VectorXd batch = solve_batch(problem);
  // Coordinates of some ten metres; rounding of twelve updates.
  RC_ASSERT((run_filter(problem, "standard", false) - batch).norm() < 1e-10);
  RC_ASSERT((run_filter(problem, "right_invariant", false) - batch).norm() < 1e-10);
  RC_ASSERT((run_filter(problem, "standard", true) - batch).norm() < 1e-10);
}
