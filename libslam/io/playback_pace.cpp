#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>

#include <libslam/io/playback_pace.hpp>

namespace libslam {
namespace {

/// Longest sleep in one piece: how soon an interrupt is noticed.
constexpr std::chrono::milliseconds kSlice{50};

}  // namespace

PlaybackPace::PlaybackPace(const Pacing& pacing) : pacing_(pacing) {
  if (!(pacing.factor > 0.0) || !std::isfinite(pacing.factor))
    throw std::invalid_argument("playback factor must be positive, not " +
                                std::to_string(pacing.factor));
}

bool PlaybackPace::wait(const LogStep& step) {
  const auto goes_on = [&] { return !pacing_.before_step || pacing_.before_step(step); };
  if (pacing_.mode != PaceMode::kRealTime) return goes_on();
  const auto now = [] { return std::chrono::steady_clock::now(); };
  if (!log_start_) {
    log_start_ = step.time;
    wall_start_ = now();
  }
  const std::chrono::duration<double> offset((step.time - *log_start_) / pacing_.factor);
  for (;;) {
    if (!goes_on()) return false;
    const std::chrono::duration<double> left = offset - (now() - wall_start_);
    if (left.count() <= 0.0) return true;
    std::this_thread::sleep_for(std::min<std::chrono::duration<double>>(left, kSlice));
  }
}

}  // namespace libslam
