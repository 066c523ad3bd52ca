#include <sys/resource.h>

#include <libslam/pipeline/process_usage.hpp>

namespace libslam {

namespace {

rusage usage_so_far() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage;
}

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

}  // namespace

double cpu_seconds() {
  const rusage usage = usage_so_far();
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_memory_mb() {
  return static_cast<double>(usage_so_far().ru_maxrss) / 1024.0;
}

}  // namespace libslam
