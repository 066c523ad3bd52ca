#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include <libslam/map/csv_text.hpp>

namespace libslam {
namespace {

template <typename T>
void append_chars(std::string& text, T value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  text.append(buffer.data(), end);
}

template <typename T>
T parse_chars(std::string_view cell, TextPlace place, const char* kind) {
  while (!cell.empty() && cell.front() == ' ') cell.remove_prefix(1);
  while (!cell.empty() && cell.back() == ' ') cell.remove_suffix(1);
  T value{};
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size())
    throw_at(place,
             std::string("expected ") + kind + ", found '" + std::string(cell.substr(0, 40)) + "'");
  return value;
}

}  // namespace

void append_number(std::string& text, double value) {
  append_chars(text, value);
}
void append_number(std::string& text, std::int64_t value) {
  append_chars(text, value);
}

void append_time(std::string& text, double time) {
  if (!(std::abs(time) < 9e15))
    throw std::invalid_argument("time is not a finite number of seconds");
  const double magnitude = std::abs(time);
  auto seconds = static_cast<std::int64_t>(magnitude);
  auto nanoseconds = std::llround((magnitude - static_cast<double>(seconds)) * 1e9);
  if (nanoseconds == 1'000'000'000) {
    ++seconds;
    nanoseconds = 0;
  }
  if (time < 0.0 && (seconds != 0 || nanoseconds != 0)) text += '-';
  append_number(text, seconds);
  std::array<char, 16> decimals;
  std::snprintf(decimals.data(), decimals.size(), ".%09lld", static_cast<long long>(nanoseconds));
  text += decimals.data();
}

void split_cells(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    cells.push_back(line.substr(begin, comma - begin));
    if (comma == std::string_view::npos) return;
    begin = comma + 1;
  }
}

double parse_number(std::string_view cell, TextPlace place) {
  const auto value = parse_chars<double>(cell, place, "a number");
  if (!std::isfinite(value)) throw_at(place, "number is not finite: '" + std::string(cell) + "'");
  return value;
}

std::int64_t parse_integer(std::string_view cell, TextPlace place) {
  return parse_chars<std::int64_t>(cell, place, "an integer");
}

void throw_at(TextPlace place, const std::string& what) {
  throw std::runtime_error(std::string(place.file) + ":" + std::to_string(place.line) + ": " +
                           what);
}

}  // namespace libslam
