#pragma once
// Two landmarks that turn out to be one.

#include <libslam/association/landmark_registry.hpp>
#include <libslam/filter/ekf.hpp>
#include <libslam/measurement/measurement_model.hpp>

namespace libslam {

struct MergingOptions {
  int every = 10;           ///< updates of the filter from pass to pass
  double gate = 0.0;        ///< squared Mahalanobis distance up to which two landmarks are one
  double extent_gap = 0.0;  ///< farthest that two parts of one line lie apart [m]
};

/// A loop that closes leaves walls behind that were begun anew on the way. Every few updates the
/// landmarks that were seen since are compared with all others. Where two are one, that is a
/// measurement (their difference is zero but for the noise of the model), after which the one seen
/// less often goes.
class LandmarkMerging {
 public:
  explicit LandmarkMerging(const MergingOptions& options) : options_(options) {}

  /// Counts an update and makes the pass that is due. Returns the number of landmarks merged away.
  int update(GaussianState& state, Ekf& ekf, BlockId pose, const MeasurementModel& model,
             LandmarkRegistry& registry);

  /// A pass at once, over landmarks whenever they were seen.
  int merge_all(GaussianState& state, Ekf& ekf, BlockId pose, const MeasurementModel& model,
                LandmarkRegistry& registry);

  int merged() const { return merged_; }

 private:
  int pass(GaussianState& state, Ekf& ekf, BlockId pose, const MeasurementModel& model,
           LandmarkRegistry& registry, int most_unseen);
  bool merge(GaussianState& state, Ekf& ekf, BlockId pose, const MeasurementModel& model,
             LandmarkRegistry& registry, std::size_t first, std::size_t second);

  MergingOptions options_;
  LinearizedMeasurement difference_;
  int updates_ = 0, merged_ = 0;
};

}  // namespace libslam
