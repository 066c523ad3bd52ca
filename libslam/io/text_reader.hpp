#pragma once
// Rows of an untrusted text table, compressed with gzip or not.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace mrpt::io {
class CFileGZInputStream;
}

namespace libslam {

/// Reads a table row by row with bounded memory. Cells are separated by commas where the row has
/// one, else by blanks. Empty rows and rows that begin with # or % are left out. Every error is an
/// InputError "file:line: ...".
class TextReader {
 public:
  /// Throws InputError if `file` cannot be read.
  explicit TextReader(const std::string& file);
  ~TextReader();
  TextReader(const TextReader&) = delete;
  TextReader& operator=(const TextReader&) = delete;

  /// Goes to the next row; false at the end of the file.
  bool next();

  std::size_t columns() const { return cells_.size(); }
  std::string_view word(std::size_t column) const;
  /// A finite number.
  double number(std::size_t column) const;
  std::int64_t integer(std::size_t column) const;

  /// Throws InputError unless the row has at least `count` cells.
  void require_columns(std::size_t count) const;
  /// Throws InputError with the place of the current row.
  [[noreturn]] void reject(const std::string& what) const;

  const std::string& file() const { return file_; }
  std::int64_t line() const { return line_; }

 private:
  bool read_line();
  bool refill();
  void split();

  std::string file_;
  std::unique_ptr<mrpt::io::CFileGZInputStream> source_;
  std::string buffer_;
  std::size_t position_ = 0;
  std::uint64_t total_bytes_ = 0;
  std::int64_t line_ = 0;
  std::string row_;
  std::vector<std::string_view> cells_;  ///< views into `row_`
};

}  // namespace libslam
