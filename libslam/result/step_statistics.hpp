#pragma once
// Figures of a run that are gathered while it goes, in memory that does not grow with the log.

#include <array>
#include <cstdint>
#include <vector>

#include <libslam/data/step_record.hpp>
#include <libslam/result/run_summary.hpp>
#include <libslam/result/series_envelope.hpp>

namespace libslam {

/// Quantiles of positive values from logarithmic bins of one per cent width.
class LogHistogram {
 public:
  void add(double value);
  /// Within half a per cent of the true quantile for values in [1e-6, 1e6]; 0 without values.
  double quantile(double probability) const;

 private:
  static constexpr double kLowest = 1e-6, kRatio = 1.01;
  static constexpr std::size_t kBins = 2778;  // kLowest * kRatio^kBins = 1e6
  std::array<std::int64_t, kBins> counts_{};
  std::int64_t total_ = 0;
};

/// Counts, step times and innovation statistics over all steps of a run.
class StepStatistics {
 public:
  StepStatistics();
  void add(const StepRecord& step);

  std::int64_t steps() const { return steps_; }
  std::int64_t updates() const { return updates_; }

  /// Fills steps and step_ms of the timing, nis_mean, nis_in_95, gated_fraction and events of the
  /// health.
  void fill(RunSummary& summary) const;

  /// Wall time per step [ms] over the number of the step.
  const SeriesEnvelope& step_times() const { return step_times_; }
  /// Of the last step.
  const std::vector<CalibrationValue>& calibration() const { return calibration_; }
  const std::vector<AdaptedNoise>& noise() const { return noise_; }
  /// Steps with the event "disturbance".
  std::int64_t disturbances() const { return disturbances_; }
  /// The first kMostEvents of them.
  const std::vector<RunEvent>& events() const { return events_; }

  static constexpr std::size_t kMostEvents = 1000;

 private:
  struct Band {
    double lower, upper;
  };
  const Band& nis_band(int dof);

  std::int64_t steps_ = 0, updates_ = 0, nis_inside_ = 0, nis_dof_ = 0;
  std::int64_t accepted_ = 0, gated_ = 0;
  double nis_sum_ = 0.0, ms_sum_ = 0.0, ms_max_ = 0.0;
  LogHistogram ms_;
  std::vector<Band> nis_bands_;  // by degrees of freedom, filled as they occur
  SeriesEnvelope step_times_;
  std::vector<CalibrationValue> calibration_;
  std::vector<AdaptedNoise> noise_;
  std::int64_t disturbances_ = 0;
  std::vector<RunEvent> events_;
};

}  // namespace libslam
