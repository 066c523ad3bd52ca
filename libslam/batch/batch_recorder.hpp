#pragma once
// Collects what a filter was given and what it took it for, so that the same data can be used
// again.

#include <cstdint>
#include <span>
#include <vector>

#include <libslam/batch/batch_log.hpp>
#include <libslam/pipeline/pipeline.hpp>

namespace libslam {

class BatchRecorder final : public FilterObserver {
 public:
  /// `filter` must outlive the recorder.
  explicit BatchRecorder(const EkfSlam& filter) : filter_(filter) {}

  void on_motion(const MotionAction* action) override;
  void on_update(std::span<const Feature> features, const UpdateOutcome& outcome) override;
  /// Closes the step with the pose that the filter has now.
  void end_step(std::int64_t index, double time);

  /// The steps so far. Left out are features that were gated or undecided, and sightings of
  /// landmarks that were given up since.
  BatchLog log() const;
  /// The filter's own answer: the pose of each step as it was then, landmarks and calibration as
  /// they are now. Belongs to log().
  BatchEstimate estimate() const;

 private:
  const EkfSlam& filter_;
  std::vector<BatchStep> steps_;  // sightings name a birth, not a landmark of the log
  BatchStep step_;
  std::vector<Eigen::Vector3d> path_;
  std::vector<std::int64_t> births_;     // identity of every landmark that was ever added
  std::vector<std::size_t> registered_;  // birth of every landmark in the registry, in its order
};

}  // namespace libslam
