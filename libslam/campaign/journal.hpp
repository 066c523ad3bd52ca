#pragma once
// What a campaign has computed so far, on disk after every run, so that nothing is computed twice.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace libslam {

/// An append-only file of (number, bytes), each record with a checksum. What a crash has cut off or
/// garbled at the end is dropped when the file is opened again.
class Journal {
 public:
  struct Record {
    std::uint64_t number = 0;
    std::vector<std::uint8_t> bytes;
  };
  enum class Opening { kContinue, kReplace };

  /// Opens or creates `file` for what `digest` identifies. Throws std::runtime_error naming the
  /// file if it belongs to something else, is no journal, is open in another process, or cannot be
  /// written; it is then unchanged. `kReplace` drops what the file holds, whatever it is.
  Journal(const std::filesystem::path& file, const std::string& digest,
          Opening opening = Opening::kContinue);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// What earlier sessions have left behind; empty after the first call.
  std::vector<Record> take_records() { return std::exchange(records_, {}); }
  /// Appends and hands the record to the operating system. Throws std::runtime_error.
  void append(const Record& record);

 private:
  void open_alone();
  std::uintmax_t read(const std::string& title);

  std::filesystem::path file_;
  int lock_ = -1;
  std::ofstream out_;
  std::vector<Record> records_;
};

}  // namespace libslam
