#pragma once
// A bar with the remaining time, on terminals alone.

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
  bool shown_, drawn_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::size_t earlier_ = 0;
};

/// "45 s", "12:05 min" or "3:07 h".
std::string describe_duration(double seconds);

}  // namespace libslam
