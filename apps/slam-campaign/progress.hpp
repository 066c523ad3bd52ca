#pragma once
// A bar with the remaining time on terminals, elsewhere a line per minute.

#include <chrono>
#include <cstddef>
#include <string>

namespace libslam {

class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` counts what earlier sessions have done, too.
  void show(std::size_t done, std::size_t total);

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_, terminal_, counting_ = false;
  Clock::time_point start_ = Clock::now(), last_line_ = start_;
  std::size_t earlier_ = 0;
};

/// "45 s", "12:05 min" or "3:07 h".
std::string describe_duration(double seconds);

}  // namespace libslam
