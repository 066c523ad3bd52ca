#pragma once
// A shipped configuration on a log, beside the batch optimum of the same data.

#include <tests/golden/log_run.hpp>

#include <libslam/batch/batch_comparison.hpp>
#include <libslam/batch/residuals.hpp>
#include <libslam/pipeline/factory.hpp>
#include <libslam/pipeline/landmark_identity.hpp>
#include <libslam/result/alignment.hpp>

namespace libslam::test {

struct BatchRun {
  Parameters parameters;
  FilterReplay replay;
  BatchResult batch;
  BatchComparison comparison;
};

/// Like run_imported; with `on_line_steps` also the comparison at so many steps.
inline BatchRun batch_imported(const std::string& config, const ImportedLog& log,
                               const TemporaryDirectory& scratch,
                               const std::vector<std::string>& settings = {},
                               int on_line_steps = 0) {
  const std::string rawlog = (scratch.path() / "batch.rawlog").string();
  write_imported_log(log, rawlog);
  BatchRun run;
  run.parameters = load_yaml(std::filesystem::path(LIBSLAM_CONFIG_DIR) / config);
  for (const auto& setting : settings) set_parameter(run.parameters, setting);
  validate(run.parameters);
  const GroundTruth truth = read_truth(find_truth(rawlog));
  const EkfSlamParts parts = make_filter_parts(run.parameters);
  run.replay = replay_filter(rawlog, run.parameters);
  run.batch = optimize_batch(run.replay.log, parts, run.replay.estimate);
  run.comparison =
      compare_with_batch(run.replay, run.batch, truth, landmark_identity(run.parameters));
  if (on_line_steps > 0)
    run.comparison.on_line = compare_on_line(run.replay, parts, run.batch, truth, on_line_steps);
  return run;
}

/// The log with every residual at the batch optimum multiplied by `factor`, its noise as it was.
/// Its own optimum is the same, because the gradient there is `factor` times zero. For composed
/// pose increments and planar points.
inline BatchLog scale_residuals(const BatchRun& run, double factor) {
  const EkfSlamParts parts = make_filter_parts(run.parameters);
  SightingWorkspace at(*parts.measurement);
  const BatchEstimate& best = run.batch.estimate;
  BatchLog log = run.replay.log;
  Eigen::Vector3d before = best.start;
  for (std::size_t k = 0; k < log.steps.size(); ++k) {
    const Eigen::Vector3d& pose = best.path[k];
    for (auto& motion : log.steps[k].motions) {  // one a step in such logs
      const Eigen::Vector3d moved = transform_pose(invert({before[0], before[1], before[2]}), pose);
      Eigen::Vector3d residual = motion->increment - moved;
      residual[2] = wrap_angle(residual[2]);
      motion->increment = moved + factor * residual;
    }
    at.state.set_estimate(at.pose, pose);
    for (BatchSighting& seen : log.steps[k].sightings) {
      at.state.set_estimate(at.landmark, best.landmarks[seen.landmark]);
      at.model.linearize(at.state, at.pose, at.landmark, seen.feature, at.linearized);
      seen.feature.z += (factor - 1.0) * at.linearized.innovation;
    }
    before = pose;
  }
  return log;
}

/// RMSE [m] between the landmarks of the filter of `run` on `log` and the optimum of `run`. The
/// identities of the landmarks are those of the log.
inline double distance_to_optimum(const BatchRun& run, const BatchLog& log) {
  EkfSlam filter(make_filter_parts(run.parameters));
  std::vector<Feature> features;
  for (const BatchStep& step : log.steps) {
    for (const auto& motion : step.motions) filter.propagate(motion ? &*motion : nullptr);
    features.clear();
    for (const BatchSighting& seen : step.sightings) features.push_back(seen.feature);
    if (!features.empty()) filter.update(features);
  }
  const LandmarkMap map(filter.landmarks());
  double squares = 0.0;
  for (const LandmarkEstimate& best : run.comparison.batch.map)
    squares += (map.find(best.id)->mean - best.mean).squaredNorm();
  return std::sqrt(squares / static_cast<double>(map.size()));
}

}  // namespace libslam::test
