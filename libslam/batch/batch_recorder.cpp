#include <optional>
#include <utility>

#include <libslam/batch/batch_recorder.hpp>

namespace libslam {

void BatchRecorder::on_motion(const MotionAction* action) {
  step_.motions.push_back(action != nullptr ? std::optional(*action) : std::nullopt);
}

void BatchRecorder::on_update(std::span<const Feature> features, const UpdateOutcome& outcome) {
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Verdict& verdict = outcome.verdicts[i];
    if (verdict.outcome == Outcome::kNew) {
      registered_.push_back(births_.size());
      births_.push_back(kNoIdentity);  // the registry has it, see below
    }
    if (verdict.outcome == Outcome::kNew || verdict.outcome == Outcome::kPaired)
      step_.sightings.push_back({registered_[verdict.landmark], features[i]});
  }
  // The registry keeps its order when it gives landmarks up; new ones stand at its end and outlive
  // the update that brought them.
  const auto landmarks = filter_.registry().landmarks();
  for (int back = 1; back <= outcome.new_landmarks; ++back)
    births_[registered_.end()[-back]] = landmarks.end()[-back].id;
  std::size_t kept = 0;
  std::erase_if(registered_, [&](std::size_t birth) {
    if (kept == landmarks.size() || births_[birth] != landmarks[kept].id) return true;
    ++kept;
    return false;
  });
}

void BatchRecorder::end_step(std::int64_t index, double time) {
  step_.index = index;
  step_.time = time;
  steps_.push_back(std::exchange(step_, {}));
  path_.push_back(filter_.state().estimate(filter_.pose()));
}

BatchLog BatchRecorder::log() const {
  BatchLog log;
  std::vector<std::optional<std::size_t>> landmark_of(births_.size());
  for (std::size_t i = 0; i < registered_.size(); ++i) {
    landmark_of[registered_[i]] = i;
    log.landmarks.push_back(births_[registered_[i]]);
  }
  log.steps = steps_;
  for (BatchStep& step : log.steps) {
    std::erase_if(step.sightings,
                  [&](const BatchSighting& seen) { return !landmark_of[seen.landmark]; });
    for (BatchSighting& seen : step.sightings) seen.landmark = *landmark_of[seen.landmark];
  }
  return log;
}

BatchEstimate BatchRecorder::estimate() const {
  BatchEstimate estimate;
  estimate.path = path_;
  for (const RegisteredLandmark& landmark : filter_.registry().landmarks())
    estimate.landmarks.emplace_back(filter_.state().estimate(landmark.block));
  const std::vector<CalibrationValue> calibration = filter_.calibration();
  estimate.calibration.resize(static_cast<Eigen::Index>(calibration.size()));
  for (std::size_t i = 0; i < calibration.size(); ++i)
    estimate.calibration[static_cast<Eigen::Index>(i)] = calibration[i].mean;
  return estimate;
}

}  // namespace libslam
