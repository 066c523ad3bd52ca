#include <algorithm>
#include <ceres/ceres.h>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <libslam/batch/batch_optimizer.hpp>
#include <libslam/batch/residuals.hpp>

namespace libslam {

namespace {

constexpr int kMaxReweightings = 10;
constexpr double kSettled = 1e-6;  // relative change of chi-square by new weights

class Cost final : public ceres::CostFunction {
 public:
  explicit Cost(std::unique_ptr<Residual> residual) : residual_(std::move(residual)) {
    set_num_residuals(residual_->rows());
    *mutable_parameter_block_sizes() = residual_->parameter_sizes();
  }
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    residual_->evaluate(parameters, residuals, jacobians);
    return true;
  }

 private:
  std::unique_ptr<Residual> residual_;
};

/// An unknown pose and the steps from the one before to it.
struct Node {
  Eigen::Vector3d pose;
  Eigen::VectorXd calibration;  // of the motion to this node; shared values live in the first
  std::size_t first_step = 0, last_step = 0;
  MotionResidual* motion = nullptr;  // owned by the problem
};

void require_fit(const BatchLog& log, const EkfSlamParts& parts, const BatchEstimate& start) {
  if (!parts.motion || !parts.measurement)
    throw std::invalid_argument("batch optimization needs a motion and a measurement model");
  const auto require = [](bool fits, const char* what) {
    if (!fits) throw std::invalid_argument(std::string("batch start values do not fit: ") + what);
  };
  require(start.path.size() == log.steps.size(), "one pose per step");
  require(start.landmarks.size() == log.landmarks.size(), "one estimate per landmark");
  require(start.calibration.size() == static_cast<Eigen::Index>(parts.motion->calibration().size()),
          "one value per calibration parameter");
  const int size = tangent_dimension(parts.measurement->landmark_spec());
  for (const Eigen::VectorXd& landmark : start.landmarks)
    require(landmark.size() == size, "dimension of a landmark");
  for (const BatchStep& step : log.steps)
    for (const BatchSighting& seen : step.sightings)
      require(seen.landmark < log.landmarks.size(), "landmark of a sighting");
}

class BatchProblem {
 public:
  BatchProblem(const BatchLog& log, const EkfSlamParts& parts, const BatchEstimate& start)
      : log_(log),
        parameters_(parts.motion->calibration()),
        chain_(std::make_shared<MotionChain>(*parts.motion, parts.cov_no_odometry)),
        sightings_(std::make_shared<SightingWorkspace>(*parts.measurement)),
        estimate_(start) {
    place_nodes();
    add_start_prior(parts.cov_start);
    add_calibration_priors();
    for (std::size_t n = 1; n < nodes_.size(); ++n) add_motion(n);
    add_sightings();
  }

  BatchResult solve(const BatchOptions& options) {
    ceres::Solver::Options settings;
    settings.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    settings.max_num_iterations = options.max_iterations;
    settings.function_tolerance = 1e-12;
    settings.parameter_tolerance = 1e-12;
    settings.num_threads = 1;  // residuals share workspaces
    settings.logging_type = ceres::SILENT;
    BatchResult result;
    for (int round = 0; round < kMaxReweightings; ++round) {
      reweight();
      ceres::Solver::Summary summary;
      ceres::Solve(settings, &problem_, &summary);
      if (!summary.IsSolutionUsable())
        throw std::runtime_error("batch optimization failed: " + summary.message);
      const double before = result.chi_square;
      if (round == 0) {
        result.chi_square_before = 2.0 * summary.initial_cost;
        result.degrees_of_freedom =
            summary.num_residuals_reduced - summary.num_effective_parameters_reduced;
      }
      result.chi_square = 2.0 * summary.final_cost;
      result.iterations += static_cast<int>(summary.iterations.size()) - 1;
      result.converged = summary.termination_type == ceres::CONVERGENCE;
      const bool settled = std::abs(result.chi_square - before) <= kSettled * (1.0 + before);
      if (round > 0 && settled) break;
    }
    result.poses = static_cast<int>(nodes_.size()) - (start_fixed_ ? 1 : 0);
    if (options.calibration_sigma) result.sigma_calibration = calibration_sigma();
    result.estimate = estimate();
    return result;
  }

 private:
  void place_nodes() {
    nodes_.push_back({estimate_.start, estimate_.calibration});
    bool moved = false;
    std::size_t first = 0;
    node_of_step_.assign(log_.steps.size(), 0);
    for (std::size_t k = 0; k < log_.steps.size(); ++k) {
      moved = moved || !log_.steps[k].motions.empty();
      const bool used = !log_.steps[k].sightings.empty() || k + 1 == log_.steps.size();
      if (moved && used) {
        nodes_.push_back({estimate_.path[k], estimate_.calibration, first, k});
        first = k + 1;
        moved = false;
      }
      node_of_step_[k] = nodes_.size() - 1;
    }
  }

  /// Where parameter `i` lives that drove the motion to node `n`.
  double* value(std::size_t n, std::size_t i) {
    Node& node = parameters_[i].random_walk > 0.0 ? nodes_[n] : nodes_.front();
    return &node.calibration[static_cast<Eigen::Index>(i)];
  }

  Eigen::VectorXd calibration_at(std::size_t n) {
    Eigen::VectorXd values(estimate_.calibration.size());
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      values[static_cast<Eigen::Index>(i)] = *value(n, i);
    return values;
  }

  void add(std::unique_ptr<Residual> residual, const std::vector<double*>& parameters) {
    problem_.AddResidualBlock(new Cost(std::move(residual)), nullptr, parameters);
  }

  void add_start_prior(const Eigen::Matrix3d& cov) {
    double* start = nodes_.front().pose.data();
    problem_.AddParameterBlock(start, 3);
    start_fixed_ = cov.isZero(0.0);
    if (start_fixed_)
      problem_.SetParameterBlockConstant(start);
    else
      add(std::make_unique<PosePrior>(nodes_.front().pose, cov), {start});
  }

  void add_calibration_priors() {
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      add(std::make_unique<ValuePrior>(parameters_[i].prior_mean, parameters_[i].prior_sigma),
          {value(0, i)});
  }

  void add_motion(std::size_t n) {
    Node& node = nodes_[n];
    std::vector<std::optional<MotionAction>> motions;
    double duration = 0.0;
    for (std::size_t k = node.first_step; k <= node.last_step; ++k)
      for (const auto& motion : log_.steps[k].motions) {
        motions.push_back(motion);
        if (motion) duration += motion->dt;
      }
    std::vector<double*> parameters = {nodes_[n - 1].pose.data(), node.pose.data()};
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      parameters.push_back(value(n, i));
      if (parameters_[i].random_walk > 0.0) add_walk(n, i, duration);
    }
    auto residual = std::make_unique<MotionResidual>(chain_, std::move(motions));
    node.motion = residual.get();
    add(std::move(residual), parameters);
  }

  void add_walk(std::size_t n, std::size_t i, double duration) {
    // A motion that takes no time leaves the value alone.
    const double sigma = parameters_[i].random_walk * std::sqrt(duration);
    add(std::make_unique<ValueWalk>(std::max(sigma, 1e-6 * parameters_[i].prior_sigma)),
        {value(n - 1, i), value(n, i)});
  }

  void add_sightings() {
    for (std::size_t k = 0; k < log_.steps.size(); ++k)
      for (const BatchSighting& seen : log_.steps[k].sightings)
        add(std::make_unique<SightingResidual>(sightings_, seen.feature),
            {nodes_[node_of_step_[k]].pose.data(), estimate_.landmarks[seen.landmark].data()});
  }

  void reweight() {
    for (std::size_t n = 1; n < nodes_.size(); ++n)
      nodes_[n].motion->reweight(nodes_[n - 1].pose, calibration_at(n));
  }

  Eigen::VectorXd calibration_sigma() {
    const auto count = static_cast<Eigen::Index>(parameters_.size());
    if (count == 0) return {};
    ceres::Covariance::Options options;
    options.num_threads = 1;
    ceres::Covariance covariance(options);
    std::vector<std::pair<const double*, const double*>> blocks;
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      const double* block = value(nodes_.size() - 1, i);
      blocks.emplace_back(block, block);
    }
    if (!covariance.Compute(blocks, &problem_)) return {};
    Eigen::VectorXd sigma(count);
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      double& variance = sigma[static_cast<Eigen::Index>(i)];
      covariance.GetCovarianceBlock(blocks[i].first, blocks[i].second, &variance);
      variance = std::sqrt(variance);
    }
    return sigma;
  }

  BatchEstimate estimate() {
    BatchEstimate estimate = estimate_;
    estimate.start = nodes_.front().pose;
    estimate.calibration = calibration_at(nodes_.size() - 1);
    // Steps at a node have its pose; those on the way to the next node are filled in.
    for (std::size_t k = 0; k < log_.steps.size(); ++k)
      estimate.path[k] = nodes_[node_of_step_[k]].pose;
    for (std::size_t n = 1; n < nodes_.size(); ++n) fill_steps(n, estimate);
    for (Eigen::Vector3d& pose : estimate.path) pose[2] = wrap_angle(pose[2]);
    return estimate;
  }

  void fill_steps(std::size_t n, BatchEstimate& estimate) {
    const Node& node = nodes_[n];
    const std::vector<Eigen::Vector3d> between = interpolate(
        *chain_, nodes_[n - 1].pose, node.pose, calibration_at(n), node.motion->motions());
    std::size_t motions = 0;
    for (std::size_t k = node.first_step; k < node.last_step; ++k) {
      motions += log_.steps[k].motions.size();
      if (motions > 0 && motions <= between.size()) estimate.path[k] = between[motions - 1];
    }
  }

  const BatchLog& log_;
  const std::vector<CalibrationSpec>& parameters_;
  std::shared_ptr<MotionChain> chain_;
  std::shared_ptr<SightingWorkspace> sightings_;
  BatchEstimate estimate_;
  std::vector<Node> nodes_;                // the start pose first; fixed once the problem is built
  std::vector<std::size_t> node_of_step_;  // the node at or last before each step
  bool start_fixed_ = false;
  ceres::Problem problem_;
};

}  // namespace

BatchResult optimize_batch(const BatchLog& log, const EkfSlamParts& parts,
                           const BatchEstimate& start, const BatchOptions& options) {
  require_fit(log, parts, start);
  return BatchProblem(log, parts, start).solve(options);
}

std::vector<Eigen::Vector3d> optimize_on_line(const BatchLog& log, const EkfSlamParts& parts,
                                              const BatchEstimate& start,
                                              std::span<const std::size_t> steps) {
  require_fit(log, parts, start);
  BatchOptions options;
  options.calibration_sigma = false;
  std::vector<Eigen::Vector3d> poses;
  for (const std::size_t step : steps) {
    if (step >= log.steps.size()) throw std::invalid_argument("the batch log has fewer steps");
    const auto end = static_cast<std::ptrdiff_t>(step) + 1;
    const BatchLog so_far{{log.steps.begin(), log.steps.begin() + end}, log.landmarks};
    BatchEstimate known = start;
    known.path.resize(step + 1);
    poses.push_back(optimize_batch(so_far, parts, known, options).estimate.path.back());
  }
  return poses;
}

}  // namespace libslam
