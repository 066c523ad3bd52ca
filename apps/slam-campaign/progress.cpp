#include "progress.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace libslam {

std::string describe_duration(double seconds) {
  const long whole = std::lround(seconds);
  std::array<char, 32> text{};
  if (whole < 60)
    std::snprintf(text.data(), text.size(), "%ld s", whole);
  else if (whole < 3600)
    std::snprintf(text.data(), text.size(), "%ld:%02ld min", whole / 60, whole % 60);
  else
    std::snprintf(text.data(), text.size(), "%ld:%02ld h", whole / 3600, whole % 3600 / 60);
  return text.data();
}

Progress::Progress(bool quiet) : shown_(!quiet && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::show(std::size_t done, std::size_t total) {
  if (!shown_) return;
  if (!drawn_) earlier_ = done - 1;  // what a journal held took no time
  drawn_ = true;
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
  const double left =
      passed.count() / static_cast<double>(done - earlier_) * static_cast<double>(total - done);
  const std::string bar(40 * done / total, '#');
  std::fprintf(stderr, "\r[%-40s] %zu of %zu logs, %s left \033[K", bar.c_str(), done, total,
               describe_duration(left).c_str());
}

}  // namespace libslam
