#pragma once
// Numbers as text for the CSV files of a run: the same bits in, the same bytes out, in any locale.

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace libslam {

/// Appends the shortest text that reads back as exactly `value`; "nan", "inf", "-inf" where not
/// finite.
void append_number(std::string& text, double value);
void append_number(std::string& text, std::int64_t value);
void append_number(std::string& text, std::integral auto value) {
  append_number(text, static_cast<std::int64_t>(value));
}

/// Appends a time [s] with 9 decimals in fixed notation, from whole seconds and nanoseconds.
/// Throws std::invalid_argument where `time` is not finite or beyond +-9e15 s.
void append_time(std::string& text, double time);

/// The cells of one CSV line, without quoting; a trailing carriage return is dropped.
/// The views point into `line`.
void split_cells(std::string_view line, std::vector<std::string_view>& cells);

/// Where a text came from, for messages: "file:line".
struct TextPlace {
  std::string_view file;
  std::int64_t line = 0;
};

/// Parses a whole cell. Throws std::runtime_error "file:line: ..." where it is not a number, or
/// where a floating-point number is not finite.
double parse_number(std::string_view cell, TextPlace place);
std::int64_t parse_integer(std::string_view cell, TextPlace place);

/// std::runtime_error with the message "file:line: `what`".
[[noreturn]] void throw_at(TextPlace place, const std::string& what);

}  // namespace libslam
