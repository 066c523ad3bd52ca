#pragma once
// A ceiling on what a parser may allocate while it works on untrusted data.

#include <cstdint>

namespace libslam {

/// While an object of this class lives, the address space of the process may grow by at most
/// `bytes`; an allocation beyond that fails with std::bad_alloc instead of taking the machine's
/// memory.
///
/// Why: MRPT's readers allocate what a count in the file says before they read the elements, so the
/// number of bytes read says nothing about the memory claimed. The soft limit RLIMIT_AS is the only
/// place where such a claim can be stopped without changing MRPT. It holds for the whole process,
/// hence the budget must be far above what other threads allocate in the meantime. Nested and
/// concurrent budgets are counted; the last one to go restores the previous limit. Does nothing
/// under AddressSanitizer (its allocator aborts instead of throwing) and where /proc is not
/// mounted.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t bytes);
  ~MemoryBudget();
  MemoryBudget(const MemoryBudget&) = delete;
  MemoryBudget& operator=(const MemoryBudget&) = delete;

  /// False where a budget does nothing.
  static bool supported();

 private:
  bool active_ = false;
};

}  // namespace libslam
