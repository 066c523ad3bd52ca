#pragma once
// Where the time of a run goes.

#include <array>
#include <chrono>
#include <cstddef>
#include <string_view>

namespace libslam {

enum class Phase { kPredict, kExtract, kAssociate, kUpdate, kAugment };

/// Accumulated wall time per phase [s].
struct PhaseTimes {
  static constexpr std::array<std::string_view, 5> kNames = {"predict", "extract", "associate",
                                                             "update", "augment"};
  std::array<double, kNames.size()> seconds = {};
};

/// Adds the time from construction to destruction to one phase.
class PhaseTimer {
 public:
  PhaseTimer(PhaseTimes& times, Phase phase)
      : target_(times.seconds[static_cast<std::size_t>(phase)]), start_(Clock::now()) {}
  ~PhaseTimer() { target_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& target_;
  Clock::time_point start_;
};

}  // namespace libslam
