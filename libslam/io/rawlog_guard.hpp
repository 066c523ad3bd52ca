#pragma once
// Objects of an untrusted rawlog, one at a time, behind limits that MRPT's own reader does not
// have.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <mrpt/serialization/CSerializable.h>

namespace libslam {

/// Limits on what a rawlog may ask for. The defaults are far above any log of the data sets known.
struct GuardLimits {
  std::uint64_t object_bytes = 128ULL << 20;  ///< serialized size of one entry
  std::uint64_t memory_bytes = 512ULL << 20;  ///< memory that reading one entry may claim
  std::uint64_t total_bytes = 1ULL << 40;     ///< decompressed size of the whole log
  double expansion = 200.0;  ///< decompressed / compressed size, beyond `free_bytes`
  std::uint64_t free_bytes = 64ULL
                             << 20;  ///< decompressed size below which expansion is not judged
};

enum class EntryKind { kAction, kFrame, kObservation, kForeign };

/// One object of a rawlog.
struct RawlogEntry {
  std::int64_t number = 0;  ///< place in the file, from 0
  EntryKind kind = EntryKind::kForeign;
  std::string class_name;                          ///< as stored, e.g. "mrpt::obs::CSensoryFrame"
  mrpt::serialization::CSerializable::Ptr object;  ///< null for a stored null pointer
  std::uint64_t bytes = 0;                         ///< serialized size
};

/// Reads a rawlog, compressed with gzip or not, with bounded memory.
///
/// A file that is no rawlog at all is rejected with InputError: by the constructor where the file
/// itself says so (missing, a directory, empty, no class of a rawlog at its start), by the first
/// `next` where its first entry cannot be read. A defect further on ends the log: `next` returns
/// nothing, and `damage` says what was found; entries have no length on disk, so there is nothing
/// to resume at.
class RawlogGuard {
 public:
  explicit RawlogGuard(const std::string& file, const GuardLimits& limits = {});
  ~RawlogGuard();
  RawlogGuard(const RawlogGuard&) = delete;
  RawlogGuard& operator=(const RawlogGuard&) = delete;

  /// The next entry; nothing at the end of the log or where it is damaged.
  std::optional<RawlogEntry> next();

  /// Why the rest of the file cannot be read, naming the entry; empty for a sound log.
  const std::string& damage() const { return damage_; }

  /// Part of the file that was read, in [0, 1].
  double progress() const;

  const std::string& file() const { return file_; }

 private:
  class Stream;
  void open();
  std::optional<RawlogEntry> fail(const std::string& what);

  std::string file_;
  GuardLimits limits_;
  std::unique_ptr<Stream> stream_;
  std::int64_t number_ = 0;
  std::string damage_;
  bool ended_ = false;
};

}  // namespace libslam
