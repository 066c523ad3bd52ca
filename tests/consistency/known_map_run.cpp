#include <algorithm>
#include <cmath>
#include <optional>
#include <tests/consistency/known_map_run.hpp>
#include <thread>

#include <Eigen/Dense>

#include <libslam/filter/ekf_slam.hpp>
#include <libslam/frontend/odometry.hpp>
#include <libslam/pipeline/factory.hpp>
#include <libslam/pipeline/simulation.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam::test {

namespace {

using Places = std::map<std::int64_t, Eigen::Vector2d>;

/// A model whose landmarks stand where the map says, without error, from their first sighting on.
class KnownMap final : public MeasurementModel {
 public:
  KnownMap(std::unique_ptr<MeasurementModel> model, const Places& places)
      : model_(std::move(model)), places_(places) {}
  BlockSpec landmark_spec() const override { return model_->landmark_spec(); }
  MeasurementVector predict(const GaussianState& state, BlockId pose, BlockId landmark,
                            const Feature& feature) const override {
    return model_->predict(state, pose, landmark, feature);
  }
  void linearize(const GaussianState& state, BlockId pose, BlockId landmark, const Feature& feature,
                 LinearizedMeasurement& out) const override {
    model_->linearize(state, pose, landmark, feature, out);
  }
  void initialize(const GaussianState&, BlockId, const Feature& feature,
                  Initialization& out) const override {
    out.estimate = places_.at(feature.id);
    out.wrt.clear();
    out.cov_noise = BlockMatrix::Zero(2, 2);
  }

 private:
  std::unique_ptr<MeasurementModel> model_;
  const Places& places_;
};

class Localizer {
 public:
  /// `known`: the step of the noise that the filter is told of; null: none.
  Localizer(const Parameters& parameters, const Places& places, const NoiseStepParameters* known)
      : odometry_(parameters.input),
        frontend_(make_frontend(parameters)),
        filter_(parts(parameters, places)),
        known_(known) {}

  void process(const LogStep& step, const Eigen::Vector3d& truth) {
    if (step.action)
      if (const auto action = odometry_.read(step)) filter_.propagate(&*action);
    if (!step.frame) return;
    frontend_->extract(*step.frame, batches_);
    if (!start_time_) start_time_ = step.time;
    for (FeatureBatch& batch : batches_) {
      if (known_ != nullptr) tell_noise(step.time - *start_time_, batch);
      const UpdateOutcome outcome = filter_.update(batch);
      if (!filter_.healthy() || (outcome.accepted == 0 && outcome.gated == count(outcome)))
        ++figures.unused;
    }
    Eigen::Vector3d error = filter_.state().estimate(filter_.pose()) - truth;
    error[2] = wrap_angle(error[2]);
    const Eigen::Matrix3d cov = filter_.state().covariance_of(filter_.pose());
    squares += error.head<2>().squaredNorm();
    if (cov.determinant() > 1e-18) {
      nees += error.dot(cov.ldlt().solve(error));
      ++nees_count;
    }
    const std::vector<AdaptedNoise> noise = filter_.noise();
    figures.sigma_range.push_back(noise.empty() ? 0.0 : noise[0].sigma);
    ++observations;
  }

  LocalizationFigures figures;
  double squares = 0.0, nees = 0.0;
  int observations = 0, nees_count = 0;

 private:
  void tell_noise(double time, FeatureBatch& batch) const {
    if (time < known_->begin_s || time >= known_->end_s) return;
    for (Feature& feature : batch) feature.cov *= known_->factor * known_->factor;
  }
  static int count(const UpdateOutcome& outcome) {
    return std::max(1, static_cast<int>(outcome.verdicts.size()));
  }
  static EkfSlamParts parts(const Parameters& parameters, const Places& places) {
    EkfSlamParts parts = make_filter_parts(parameters);
    parts.measurement = std::make_unique<KnownMap>(std::move(parts.measurement), places);
    return parts;
  }

  OdometryReader odometry_;
  std::unique_ptr<Frontend> frontend_;
  EkfSlam filter_;
  const NoiseStepParameters* known_;
  std::optional<double> start_time_;
  std::vector<FeatureBatch> batches_;
};

std::vector<std::unique_ptr<Localizer>> drive(
    const Scenario& scenario, const std::map<std::string, LocalizationFilter>& filters,
    std::uint64_t seed) {
  const auto simulator = make_simulator(scenario, seed);
  Places places;
  for (const TrueLandmark& landmark : simulator->landmarks())
    places[landmark.id] =
        transform_back(simulator->start(), Eigen::Vector2d(landmark.position.head<2>()));
  std::vector<std::unique_ptr<Localizer>> lanes;
  for (const auto& [name, filter] : filters)
    lanes.push_back(std::make_unique<Localizer>(
        filter.parameters, places,
        filter.knows_the_noise_step ? &scenario.faults.noise_step : nullptr));
  while (const auto step = simulator->next())
    for (auto& lane : lanes)
      lane->process(step->step, relative_pose(simulator->start(), step->T_world_robot));
  return lanes;
}

LocalizationFigures pooled(const std::vector<std::vector<std::unique_ptr<Localizer>>>& drives,
                           std::size_t lane) {
  LocalizationFigures all;
  double squares = 0.0, nees = 0.0;
  int observations = 0, nees_count = 0;
  std::size_t length = drives[0][lane]->figures.sigma_range.size();
  for (const auto& drive : drives)
    length = std::min(length, drive[lane]->figures.sigma_range.size());
  all.sigma_range.assign(length, 0.0);
  for (const auto& drive : drives) {
    const Localizer& one = *drive[lane];
    squares += one.squares;
    nees += one.nees;
    observations += one.observations;
    nees_count += one.nees_count;
    all.unused += one.figures.unused;
    for (std::size_t k = 0; k < length; ++k)
      all.sigma_range[k] += one.figures.sigma_range[k] / static_cast<double>(drives.size());
  }
  all.rmse_position = std::sqrt(squares / observations);
  all.nees = nees / nees_count;
  return all;
}

}  // namespace

std::map<std::string, LocalizationFigures> localize(
    const Scenario& scenario, const std::map<std::string, LocalizationFilter>& filters, int drives,
    std::uint64_t first_seed) {
  std::vector<std::vector<std::unique_ptr<Localizer>>> done(static_cast<std::size_t>(drives));
  std::vector<std::jthread> threads;
  const std::size_t workers = std::max(1U, std::thread::hardware_concurrency());
  for (std::size_t worker = 0; worker < workers; ++worker)
    threads.emplace_back([&, worker] {
      for (std::size_t i = worker; i < done.size(); i += workers)
        done[i] = drive(scenario, filters, first_seed + i);
    });
  threads.clear();
  std::map<std::string, LocalizationFigures> figures;
  std::size_t lane = 0;
  for (const auto& [name, filter] : filters) figures[name] = pooled(done, lane++);
  return figures;
}

}  // namespace libslam::test
