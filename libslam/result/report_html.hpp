#pragma once
// Pieces of HTML that all report pages are made of.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace libslam {

/// `text` with the five characters that HTML gives a meaning replaced.
std::string escape_html(std::string_view text);

/// Four significant digits and the unit behind a narrow space.
std::string format_figure(double value, const char* unit = "");

/// One card: a heading and rows of name and value. Names and values are escaped.
class Card {
 public:
  explicit Card(const char* title);
  Card& row(std::string_view name, const std::string& value);
  /// `value` times `factor`; no row without a value.
  Card& row(const char* name, const std::optional<double>& value, const char* unit = "",
            double factor = 1.0);
  /// Empty without rows.
  std::string html() const;

 private:
  std::string html_;
  int rows_ = 0;
};

/// A list under a heading, every entry escaped; empty without any.
std::string warnings_html(const char* title, const std::vector<std::string>& warnings);

}  // namespace libslam
