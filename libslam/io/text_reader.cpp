#include <mrpt/io/CFileGZInputStream.h>

#include <libslam/io/input_error.hpp>
#include <libslam/io/input_file.hpp>
#include <libslam/io/text_reader.hpp>
#include <libslam/map/csv_text.hpp>

namespace libslam {
namespace {

constexpr std::size_t kBlock = 1U << 16;
constexpr std::size_t kMaxLine = 1U << 16;
constexpr std::uint64_t kMaxTotal = 4ULL << 30;
constexpr std::string_view kBlanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

/// `parse` with its error as an InputError.
auto parsed(auto parse) {
  try {
    return parse();
  } catch (const std::runtime_error& error) {
    throw InputError(error.what());
  }
}

}  // namespace

TextReader::TextReader(const std::string& file)
    : file_(file), source_(std::make_unique<mrpt::io::CFileGZInputStream>()) {
  require_input_file(file);
  if (!source_->open(file)) throw InputError(file + ": cannot be opened for reading");
}

TextReader::~TextReader() = default;

bool TextReader::refill() {
  buffer_.resize(kBlock);
  const std::size_t got = source_->Read(buffer_.data(), kBlock);
  if (got > kBlock) reject("the compressed data are corrupt");  // zlib reports errors as -1
  total_bytes_ += got;
  if (total_bytes_ > kMaxTotal) reject("the file holds more than 4 GiB of text");
  buffer_.resize(got);
  position_ = 0;
  return got > 0;
}

bool TextReader::read_line() {
  row_.clear();
  for (bool any = false;; any = true) {
    if (position_ == buffer_.size() && !refill()) {
      if (any) ++line_;
      return any;
    }
    const std::size_t end = buffer_.find('\n', position_);
    row_.append(buffer_, position_, end == std::string::npos ? end : end - position_);
    if (row_.size() > kMaxLine) {
      ++line_;
      reject("line longer than " + std::to_string(kMaxLine) + " characters");
    }
    if (end != std::string::npos) {
      position_ = end + 1;
      ++line_;
      return true;
    }
    position_ = buffer_.size();
  }
}

bool TextReader::next() {
  while (read_line()) {
    const std::string_view text = trimmed(row_);
    if (text.empty() || text.front() == '#' || text.front() == '%') continue;
    split();
    return true;
  }
  return false;
}

void TextReader::split() {
  std::string_view text = trimmed(row_);
  if (text.find(',') != std::string_view::npos) {
    split_cells(text, cells_);
    for (auto& cell : cells_) cell = trimmed(cell);
    return;
  }
  cells_.clear();
  while (!text.empty()) {
    const auto end = text.find_first_of(kBlanks);
    cells_.push_back(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : trimmed(text.substr(end));
  }
}

std::string_view TextReader::word(std::size_t column) const {
  require_columns(column + 1);
  return cells_[column];
}

double TextReader::number(std::size_t column) const {
  const std::string_view cell = word(column);
  return parsed([&] { return parse_number(cell, {file_, line_}); });
}

std::int64_t TextReader::integer(std::size_t column) const {
  const std::string_view cell = word(column);
  return parsed([&] { return parse_integer(cell, {file_, line_}); });
}

void TextReader::require_columns(std::size_t count) const {
  if (cells_.size() < count)
    reject("expected at least " + std::to_string(count) + " columns, found " +
           std::to_string(cells_.size()));
}

void TextReader::reject(const std::string& what) const {
  throw InputError(file_ + ":" + std::to_string(line_) + ": " + what);
}

}  // namespace libslam
