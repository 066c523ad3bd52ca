#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include <libslam/campaign/recovery.hpp>
#include <libslam/campaign/simulated_run.hpp>
#include <libslam/data/step_events.hpp>
#include <libslam/pipeline/landmark_identity.hpp>
#include <libslam/pipeline/mrpt_filter.hpp>
#include <libslam/pipeline/pipeline.hpp>
#include <libslam/pipeline/simulation.hpp>
#include <libslam/result/step_statistics.hpp>
#include <libslam/result/truth_comparison.hpp>
#include <libslam/result/truth_json.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

/// A filter of the campaign, ours or MRPT's.
class Contestant {
 public:
  Contestant(const Variant& variant, const TrueState& truth) {
    if (variant.engine == Engine::kLibslam)
      pipeline_ = std::make_unique<Pipeline>(variant.parameters, &truth);
    else
      mrpt_ =
          std::make_unique<MrptFilter>(variant.parameters, variant.engine == Engine::kMrptDavison
                                                               ? MrptFilter::Method::kDavison
                                                               : MrptFilter::Method::kDefault);
  }

  /// Nothing from MRPT between observations.
  std::optional<StepRecord> process(const LogStep& step) {
    return mrpt_ ? mrpt_->process(step) : pipeline_->process(step);
  }
  bool healthy() const { return mrpt_ || pipeline_->filter().healthy(); }
  LandmarkMap landmarks() const {
    if (mrpt_) return mrpt_->landmarks();
    LandmarkMap map;
    for (auto& landmark : pipeline_->filter().landmarks()) map.add(std::move(landmark));
    return map;
  }
  std::vector<CalibrationValue> calibration() const {
    return mrpt_ ? std::vector<CalibrationValue>{} : pipeline_->filter().calibration();
  }

  std::vector<AdaptedNoise> noise() const {
    return mrpt_ ? std::vector<AdaptedNoise>{} : pipeline_->filter().noise();
  }

 private:
  std::unique_ptr<MrptFilter> mrpt_;
  std::unique_ptr<Pipeline> pipeline_;
};

/// What every filter knows at the first step: it is at the origin.
StepRecord start_of(const LogStep& step) {
  StepRecord record;
  record.index = step.index;
  record.time = step.time;
  return record;
}

/// A filter, what it has estimated so far, and the verdict.
class Lane {
 public:
  Lane(const Variant& variant, const TrueState& truth, double diverged_beyond,
       const KidnapParameters& kidnap)
      : identity_(landmark_identity(variant.parameters)),
        diverged_beyond_(diverged_beyond),
        recovery_(kidnap) {
    attempt([&] { contestant_.emplace(variant, truth); });
  }

  void process(const LogStep& step, const Eigen::Vector3d& truth) {
    if (step.frame) ++observations_;
    if (!status_.empty()) return;
    attempt([&] {
      const Clock::time_point start = Clock::now();
      auto record = contestant_->process(step);
      seconds_ += std::chrono::duration<double>(Clock::now() - start).count();
      // All filters know the start, also one that says nothing before its first update.
      if (!record && path_.empty()) record = start_of(step);
      if (record) judge(*record, truth, step.frame != nullptr);
    });
  }

  VariantOutcome finish(const GroundTruth& truth, bool with_series) {
    VariantOutcome outcome;
    if (status_.empty()) attempt([&] { describe(truth, with_series, outcome); });
    if (!status_.empty()) outcome = {};
    outcome.status = status_.empty() ? "done" : status_;
    outcome.figures["timing"] = {{"filter_s", seconds_}};
    return outcome;
  }

 private:
  /// What one filter throws is its own affair.
  template <class Action>
  void attempt(Action&& action) {
    try {
      action();
    } catch (const std::exception& error) {
      status_ = std::string("failed: ") + error.what();
    }
  }

  void judge(const StepRecord& record, const Eigen::Vector3d& truth, bool observed) {
    statistics_.add(record);
    const double error = (record.pose - truth).head<2>().norm();
    if (!contestant_->healthy() || !record.pose.allFinite() || !record.cov.allFinite() ||
        (diverged_beyond_ > 0.0 && !(error <= diverged_beyond_))) {
      status_ = "diverged";
      return;
    }
    // All filters are judged at all observations, whether they used them or not.
    if (path_.empty() || observed) {
      path_.push_back({record.index, record.time, record.pose, record.cov});
      observation_of_pose_.push_back(observations_ - 1);
      recovery_.observe(record.time - path_.front().time, error);
    }
    if (has_event(record.event, "disturbance")) ++disturbances_;
  }

  void describe(const GroundTruth& truth, bool with_series, VariantOutcome& outcome) const {
    const auto calibration = contestant_->calibration();
    const LandmarkMap map = contestant_->landmarks();
    const TruthComparison comparison =
        compare_with_truth(path_, map, calibration_means(calibration), truth, identity_);
    outcome.figures["truth"] = truth_to_json(comparison);
    RunSummary summary;
    statistics_.fill(summary);
    Json& health = outcome.figures["health"] = Json::object();
    if (summary.health.nis_mean) health["nis_mean"] = *summary.health.nis_mean;
    if (summary.health.nis_in_95) health["nis_in_95"] = *summary.health.nis_in_95;
    if (summary.health.gated_fraction) health["gated_fraction"] = *summary.health.gated_fraction;
    health["landmarks"] = map.size();
    health["disturbances"] = disturbances_;
    if (Json recovery = recovery_.figures(); !recovery.is_null())
      outcome.figures["recovery"] = std::move(recovery);
    for (const CalibrationValue& value : calibration)
      outcome.figures["calibration"][value.name] = {
          {"mean", value.mean}, {"sigma", value.sigma}, {"observable", value.observable ? 1 : 0}};
    for (const AdaptedNoise& noise : contestant_->noise())
      outcome.figures["noise"][noise.name] = {{"sigma", noise.sigma},
                                              {"configured", noise.configured}};
    const std::vector<PoseMatch> matches = match_poses(path_, truth.path);
    add_nees(truth, matches, outcome);
    add_errors(truth, matches, outcome, with_series);
  }

  void add_nees(const GroundTruth& truth, const std::vector<PoseMatch>& matches,
                VariantOutcome& outcome) const {
    const std::vector<double> nees = pose_nees(path_, truth.path, matches);
    outcome.nees.assign(observations_, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < matches.size(); ++i)
      outcome.nees[observation_of_pose_[matches[i].estimate]] = nees[i];
  }

  void add_errors(const GroundTruth& truth, const std::vector<PoseMatch>& matches,
                  VariantOutcome& outcome, bool with_series) const {
    for (const PoseMatch& match : matches) {
      const EstimatedPose& estimate = path_[match.estimate];
      Eigen::Vector3d error = estimate.pose - truth.path.poses[match.truth];
      error[2] = wrap_angle(error[2]);
      outcome.sums.x += error[0] * error[0];
      outcome.sums.y += error[1] * error[1];
      outcome.sums.heading += error[2] * error[2];
      ++outcome.sums.count;
      if (!with_series) continue;
      outcome.series.times.push_back(estimate.time - truth.path.times.front());
      for (std::size_t i = 0; i < 3; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        outcome.series.errors[i].push_back(error[k]);
        outcome.series.sigmas[i].push_back(std::sqrt(estimate.cov(k, k)));
      }
    }
  }

  std::optional<Contestant> contestant_;
  LandmarkIdentity identity_;
  double diverged_beyond_;
  Recovery recovery_;
  int disturbances_ = 0;
  std::vector<EstimatedPose> path_;
  std::vector<std::size_t> observation_of_pose_;  ///< by pose of the path
  std::size_t observations_ = 0;
  StepStatistics statistics_;
  std::string status_;
  double seconds_ = 0.0;
};

/// The truth in the frame of the filters, whose origin is the start pose.
void place(const Simulator& simulator, TrueState& state, GroundTruth& truth) {
  for (TrueLandmark landmark : simulator.landmarks()) {
    const Eigen::Vector2d place =
        transform_back(simulator.start(), Eigen::Vector2d(landmark.position.head<2>()));
    landmark.position.head<2>() = place;
    state.landmarks[landmark.id] = place;
    truth.landmarks.push_back(std::move(landmark));
  }
  state.calibration = truth.calibration = simulator.calibration();
}

}  // namespace

RunOutcome run_task(const CampaignPlan& plan, const CampaignTask& task,
                    const std::atomic<bool>* stop) {
  const GridPoint& point = plan.points[task.point];
  const auto simulator = make_simulator(point.scenario, task.seed);
  TrueState state;
  GroundTruth truth;
  place(*simulator, state, truth);
  std::vector<std::unique_ptr<Lane>> lanes;
  for (const Variant& variant : point.variants)
    lanes.push_back(std::make_unique<Lane>(variant, state, plan.campaign.diverged_beyond,
                                           point.scenario.faults.kidnap));
  while (const auto step = simulator->next()) {
    if (stop != nullptr && stop->load()) throw std::runtime_error("interrupted");
    state.pose = relative_pose(simulator->start(), step->T_world_robot);
    truth.path.times.push_back(step->step.time);
    truth.path.poses.push_back(state.pose);
    for (auto& lane : lanes) lane->process(step->step, state.pose);
  }
  RunOutcome outcome;
  for (auto& lane : lanes)
    outcome.variants.push_back(lane->finish(truth, task.batch == 0 && task.run == 0));
  return outcome;
}

}  // namespace libslam
