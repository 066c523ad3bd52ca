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

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (counting_ && terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::show(std::size_t done, std::size_t total) {
  if (quiet_) return;
  if (!counting_) earlier_ = done - 1;  // what a journal held took no time
  counting_ = true;
  const Clock::time_point now = Clock::now();
  const std::chrono::duration<double> passed = now - start_;
  const double left =
      passed.count() / static_cast<double>(done - earlier_) * static_cast<double>(total - done);
  const std::string text = std::to_string(done) + " of " + std::to_string(total) + " logs, " +
                           describe_duration(left) + " left";
  if (terminal_) {
    const std::string bar(40 * done / total, '#');
    std::fprintf(stderr, "\r[%-40s] %s \033[K", bar.c_str(), text.c_str());
  } else if (now - last_line_ >= std::chrono::minutes(1)) {
    last_line_ = now;
    std::fprintf(stderr, "%s\n", text.c_str());
  }
}

}  // namespace libslam
