#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/rtti/CObject.h>
#include <mrpt/serialization/CArchive.h>

#include <libslam/io/input_error.hpp>
#include <libslam/io/input_file.hpp>
#include <libslam/io/memory_budget.hpp>
#include <libslam/io/rawlog_guard.hpp>

namespace libslam {
namespace {

/// Longest class name that MRPT accepts, and the length of the two header forms before the name.
constexpr std::size_t kMaxClassName = 120;
constexpr std::size_t kNewHeader = 1, kOldHeader = 4;

/// First line of MRPT's exception text, without its decoration and call stack.
std::string first_line(const std::exception& error) {
  std::string_view text = error.what();
  constexpr std::string_view marker = "Message:";
  if (const auto at = text.find(marker); at != std::string_view::npos)
    text.remove_prefix(at + marker.size());
  const auto begin = text.find_first_not_of(" \n");
  if (begin == std::string_view::npos) return "unknown error";
  text.remove_prefix(begin);
  return std::string(text.substr(0, text.find('\n')));
}

/// Decompressed size that a gzip file claims in its last four bytes (modulo 2^32), else the file
/// size. Serves the progress display alone: the number is untrusted.
std::uint64_t expected_bytes(const std::string& file, std::uint64_t file_bytes) {
  std::ifstream in(file, std::ios::binary);
  std::array<unsigned char, 2> magic{};
  in.read(reinterpret_cast<char*>(magic.data()), magic.size());
  if (!in || magic[0] != 0x1f || magic[1] != 0x8b) return file_bytes;
  std::array<unsigned char, 4> size{};
  in.seekg(-4, std::ios::end);
  in.read(reinterpret_cast<char*>(size.data()), size.size());
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < size.size(); ++i) bytes |= std::uint64_t{size[i]} << (8 * i);
  return std::max<std::uint64_t>(bytes, 1);
}

EntryKind kind_of(const mrpt::rtti::TRuntimeClassId& id) {
  using namespace mrpt::obs;
  if (id.derivedFrom(CLASS_ID(CObservation))) return EntryKind::kObservation;
  if (id.derivedFrom(CLASS_ID(CSensoryFrame))) return EntryKind::kFrame;
  if (id.derivedFrom(CLASS_ID(CActionCollection))) return EntryKind::kAction;
  return EntryKind::kForeign;
}

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string(bytes >> 20) + " MiB";
}

/// A class name made harmless for a one-line message.
std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32 || c > 126; }, '?');
  return text;
}

}  // namespace

/// Counts and limits what MRPT reads, and lets the guard look at the header of an entry first.
class RawlogGuard::Stream : public mrpt::io::CStream {
 public:
  Stream(const std::string& file, const GuardLimits& limits)
      : limits_(limits),
        file_bytes_(std::filesystem::file_size(file)),
        expected_bytes_(expected_bytes(file, file_bytes_)) {
    if (!source_.open(file)) throw InputError(file + ": cannot be opened for reading");
  }

  /// Up to `count` coming bytes, without consuming them.
  std::string_view peek(std::size_t count) {
    while (ahead_.size() < count) {
      std::array<char, kOldHeader + kMaxClassName> block{};
      const std::size_t got = fetch(block.data(), std::min(block.size(), count - ahead_.size()));
      if (got == 0) break;
      ahead_.append(block.data(), got);
    }
    return std::string_view(ahead_).substr(0, count);
  }

  void begin_entry() {
    entry_bytes_ = 0;
    reason_.clear();
  }

  std::size_t Read(void* buffer, std::size_t count) override {
    if (!admit(count)) return 0;
    const std::size_t from_ahead = std::min(count, ahead_.size());
    std::memcpy(buffer, ahead_.data(), from_ahead);
    ahead_.erase(0, from_ahead);
    std::size_t got = from_ahead;
    if (got < count) got += fetch(static_cast<char*>(buffer) + got, count - got);
    if (got < count && reason_.empty())
      reason_ = "the file ends in the middle of this entry (truncated)";
    entry_bytes_ += got;
    total_bytes_ += got;
    return got;
  }

  std::size_t Write(const void*, std::size_t) override { return 0; }
  std::uint64_t Seek(std::int64_t, TSeekOrigin) override { return total_bytes_; }
  std::uint64_t getTotalBytesCount() const override { return expected_bytes_; }
  std::uint64_t getPosition() const override { return total_bytes_; }

  std::uint64_t entry_bytes() const { return entry_bytes_; }
  /// Why the last read gave less than asked for; empty if it did not.
  const std::string& reason() const { return reason_; }

 private:
  bool admit(std::size_t count) {
    const std::uint64_t total = total_bytes_ + count;
    if (entry_bytes_ + count > limits_.object_bytes)
      reason_ = "this entry asks for more than " + mebibytes(limits_.object_bytes);
    else if (total > limits_.total_bytes)
      reason_ = "the log holds more than " + mebibytes(limits_.total_bytes);
    else if (total > limits_.free_bytes &&
             static_cast<double>(total) > limits_.expansion * static_cast<double>(file_bytes_))
      reason_ = "the compressed file expands more than " +
                std::to_string(static_cast<int>(limits_.expansion)) + " times";
    else
      return true;
    return false;
  }

  std::size_t fetch(char* buffer, std::size_t count) {
    const std::size_t got = source_.Read(buffer, count);
    if (got <= count) return got;
    reason_ = "the compressed data are corrupt";  // zlib reports errors as -1
    return 0;
  }

  GuardLimits limits_;
  mrpt::io::CFileGZInputStream source_;
  std::uint64_t file_bytes_, expected_bytes_;
  std::uint64_t entry_bytes_ = 0, total_bytes_ = 0;
  std::string ahead_, reason_;
};

namespace {

/// Class name at the head of an entry; empty where the bytes are no header.
std::string header_class(auto& stream) {
  const std::string_view first = stream.peek(kOldHeader);
  const bool old_form = (static_cast<unsigned char>(first[0]) & 0x80U) == 0;
  const std::size_t head = old_form ? kOldHeader : kNewHeader;
  const std::size_t length = static_cast<unsigned char>(first[0]) & 0x7FU;
  if (length == 0 || length > kMaxClassName) return {};
  if (old_form && first.substr(1) != std::string_view("\0\0\0", 3)) return {};
  const std::string_view header = stream.peek(head + length);
  if (header.size() < head + length) return {};
  return std::string(header.substr(head));
}

}  // namespace

RawlogGuard::RawlogGuard(const std::string& file, const GuardLimits& limits)
    : file_(file), limits_(limits) {
  open();
}

RawlogGuard::~RawlogGuard() = default;

void RawlogGuard::open() {
  require_input_file(file_);
  stream_ = std::make_unique<Stream>(file_, limits_);
  if (stream_->peek(1).empty()) {
    const std::string& reason = stream_->reason();
    throw InputError(file_ + ": " + (reason.empty() ? "holds no data" : reason));
  }
  const std::string name = header_class(*stream_);
  if (name.empty()) throw InputError(file_ + ": is not a rawlog (no MRPT object at its start)");
  if (mrpt::rtti::findRegisteredClass(name) == nullptr)
    throw InputError(file_ + ": entry 0: unknown class '" + printable(name) + "'");
}

std::optional<RawlogEntry> RawlogGuard::fail(const std::string& what) {
  ended_ = true;
  damage_ = file_ + ": entry " + std::to_string(number_) + ": " + what;
  if (number_ == 0) throw InputError(damage_);
  return std::nullopt;
}

std::optional<RawlogEntry> RawlogGuard::next() {
  if (ended_) return std::nullopt;
  stream_->begin_entry();
  if (stream_->peek(1).empty()) {
    if (!stream_->reason().empty()) return fail(stream_->reason());
    ended_ = true;
    return std::nullopt;
  }
  RawlogEntry entry;
  entry.number = number_;
  entry.class_name = header_class(*stream_);
  if (entry.class_name.empty()) return fail("the bytes here are no MRPT object");
  const auto* id = mrpt::rtti::findRegisteredClass(entry.class_name);
  if (id != nullptr)
    entry.kind = kind_of(*id);
  else if (entry.class_name != "nullptr")
    return fail("unknown class '" + printable(entry.class_name) + "'");
  try {
    const MemoryBudget budget(limits_.memory_bytes);
    auto archive = mrpt::serialization::archiveFrom(*stream_);
    entry.object = archive.ReadObject();
  } catch (const std::bad_alloc&) {
    return fail("this entry asks for more than " + mebibytes(limits_.memory_bytes) + " of memory");
  } catch (const std::exception& error) {
    return fail(stream_->reason().empty() ? first_line(error) : stream_->reason());
  }
  entry.bytes = stream_->entry_bytes();
  ++number_;
  return entry;
}

double RawlogGuard::progress() const {
  if (ended_) return 1.0;
  return std::min(1.0, static_cast<double>(stream_->getPosition()) /
                           static_cast<double>(stream_->getTotalBytesCount()));
}

}  // namespace libslam
