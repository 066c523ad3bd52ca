#include <array>
#include <charconv>
#include <fcntl.h>
#include <mutex>
#include <sys/resource.h>
#include <unistd.h>

#include <libslam/io/memory_budget.hpp>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LIBSLAM_ADDRESS_SANITIZER
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define LIBSLAM_ADDRESS_SANITIZER
#endif

namespace libslam {
namespace {

#ifdef LIBSLAM_ADDRESS_SANITIZER
constexpr bool kSupported = false;
#else
constexpr bool kSupported = true;
#endif

std::mutex limit_mutex;
int users = 0;
rlimit previous{};

/// Address space of this process [bytes], 0 if unknown.
std::uint64_t address_space() {
  static const int statm = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  static const long page = ::sysconf(_SC_PAGESIZE);
  std::array<char, 64> text{};
  const ssize_t length = statm < 0 ? -1 : ::pread(statm, text.data(), text.size(), 0);
  std::uint64_t pages = 0;
  if (length > 0) std::from_chars(text.data(), text.data() + length, pages);
  return pages * static_cast<std::uint64_t>(page);
}

}  // namespace

bool MemoryBudget::supported() {
  return kSupported && address_space() > 0;
}

MemoryBudget::MemoryBudget(std::uint64_t bytes) {
  const std::uint64_t used = kSupported ? address_space() : 0;
  if (used == 0) return;
  const std::lock_guard lock(limit_mutex);
  if (users == 0 && ::getrlimit(RLIMIT_AS, &previous) != 0) return;
  rlimit limit = previous;
  const rlim_t wanted = used + bytes;
  if (previous.rlim_cur != RLIM_INFINITY && previous.rlim_cur <= wanted) return;
  limit.rlim_cur = wanted;
  if (::setrlimit(RLIMIT_AS, &limit) != 0) return;
  ++users;
  active_ = true;
}

MemoryBudget::~MemoryBudget() {
  if (!active_) return;
  const std::lock_guard lock(limit_mutex);
  if (--users == 0) ::setrlimit(RLIMIT_AS, &previous);
}

}  // namespace libslam
