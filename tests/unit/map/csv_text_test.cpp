#include <bit>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/map/csv_text.hpp>

namespace libslam {
namespace {

std::string time_text(double time) {
  std::string text;
  append_time(text, time);
  return text;
}

RC_GTEST_PROP(CsvText, NumbersReadBackBitForBit, (std::uint64_t bits)) {
  const auto value = std::bit_cast<double>(bits);
  RC_PRE(std::isfinite(value));
  std::string text;
  append_number(text, value);
  RC_ASSERT(std::bit_cast<std::uint64_t>(parse_number(text, {"x", 1})) == bits);
}

TEST(CsvText, TimesHaveNineDecimals) {
  EXPECT_EQ(time_text(0.0), "0.000000000");
  EXPECT_EQ(time_text(-0.5), "-0.500000000");
  EXPECT_EQ(time_text(-1e-12), "0.000000000");
  EXPECT_EQ(time_text(1.9999999999), "2.000000000");
  EXPECT_EQ(time_text(1234567890.25), "1234567890.250000000");
  EXPECT_THROW(time_text(std::nan("")), std::invalid_argument);
  EXPECT_THROW(time_text(std::numeric_limits<double>::infinity()), std::invalid_argument);
}

RC_GTEST_PROP(CsvText, TimesReadBackWithinHalfANanosecondPlusRounding, ()) {
  const double time =
      static_cast<double>(*rc::gen::inRange<std::int64_t>(0, 2'000'000'000'000)) * 1e-3 + 1e-4 / 3;
  const double back = parse_number(time_text(time), {"x", 1});
  RC_ASSERT(std::abs(back - time) <= 0.5e-9 + time * std::numeric_limits<double>::epsilon());
}

TEST(CsvText, MalformedCellsNameFileAndLine) {
  for (const char* cell : {"", "abc", "1.0x", "nan", "inf", "1e999", "--1"}) {
    try {
      parse_number(cell, {"map.csv", 7});
      FAIL() << "accepted '" << cell << "'";
    } catch (const std::runtime_error& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("map.csv:7: ")) << error.what();
    }
  }
  EXPECT_THROW(parse_integer("1.5", {"x", 1}), std::runtime_error);
}

TEST(CsvText, CellsKeepEmptyOnesAndDropTheCarriageReturn) {
  std::vector<std::string_view> cells;
  split_cells("a,,b\r", cells);
  EXPECT_EQ(cells, (std::vector<std::string_view>{"a", "", "b"}));
}

}  // namespace
}  // namespace libslam
