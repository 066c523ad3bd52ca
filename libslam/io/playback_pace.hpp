#pragma once
// How fast a log is played.

#include <chrono>
#include <functional>
#include <optional>

#include <libslam/data/log_step.hpp>

namespace libslam {

enum class PaceMode {
  kFast,      ///< as fast as steps are asked for
  kRealTime,  ///< log time divided by `factor`
  kStep,      ///< `before_step` decides when
};

struct Pacing {
  PaceMode mode = PaceMode::kFast;
  double factor = 1.0;  ///< > 0; 2 plays twice as fast as the log was recorded
  /// Asked in every mode before a step is delivered, and again while waiting; false ends the
  /// playback. In step mode it blocks until the step is wanted.
  std::function<bool(const LogStep&)> before_step;
};

/// Holds each step back until its time has come.
class PlaybackPace {
 public:
  /// Throws std::invalid_argument unless the factor is positive and finite.
  explicit PlaybackPace(const Pacing& pacing);
  /// Returns when `step` is due: true, or false if the playback is to end.
  bool wait(const LogStep& step);

 private:
  Pacing pacing_;
  std::optional<double> log_start_;
  std::chrono::steady_clock::time_point wall_start_;
};

}  // namespace libslam
