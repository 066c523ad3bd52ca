#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <libslam/result/series_envelope.hpp>

namespace libslam {
namespace {

RC_GTEST_PROP(SeriesEnvelope, EveryBucketHoldsTheExtremesOfItsSamples,
              (const std::vector<short>& samples)) {
  SeriesEnvelope envelope(1, 8);
  for (std::size_t i = 0; i < samples.size(); ++i)
    envelope.add(static_cast<double>(i), std::array{static_cast<double>(samples[i])});
  RC_ASSERT(envelope.size() <= 8u);
  for (std::size_t b = 0; b < envelope.size(); ++b) {
    const auto begin = samples.begin() + static_cast<std::ptrdiff_t>(envelope.abscissa(b));
    const auto end = b + 1 < envelope.size()
                         ? samples.begin() + static_cast<std::ptrdiff_t>(envelope.abscissa(b + 1))
                         : samples.end();
    const auto [low, high] = std::minmax_element(begin, end);
    RC_ASSERT(envelope.range(b, 0).low == static_cast<float>(*low));
    RC_ASSERT(envelope.range(b, 0).high == static_cast<float>(*high));
  }
}

TEST(SeriesEnvelope, StaysBetweenHalfAndFullCapacityAndSplitsEvenly) {
  for (const std::size_t capacity : {7u, 8u}) {
    SeriesEnvelope envelope(1, capacity);
    for (int i = 0; i < 1000; ++i) envelope.add(i, std::array{0.0});
    EXPECT_GE(envelope.size(), capacity / 2);
    EXPECT_LE(envelope.size(), capacity);
    const double width = envelope.abscissa(1) - envelope.abscissa(0);
    for (std::size_t b = 1; b < envelope.size(); ++b)
      EXPECT_EQ(envelope.abscissa(b) - envelope.abscissa(b - 1), width);
  }
}

TEST(SeriesEnvelope, NanIsNoValue) {
  SeriesEnvelope envelope(2, 2);
  const double nan = std::nan("");
  for (int i = 0; i < 4; ++i) envelope.add(i, std::array{i == 1 ? 5.0 : nan, nan});
  EXPECT_EQ(envelope.range(0, 0).low, 5.0f);
  EXPECT_EQ(envelope.range(0, 0).high, 5.0f);
  EXPECT_TRUE(std::isnan(envelope.range(1, 0).low));
  EXPECT_TRUE(std::isnan(envelope.range(0, 1).high));
}

TEST(SeriesEnvelope, RefusesWrongShapes) {
  EXPECT_THROW(SeriesEnvelope(0, 10), std::invalid_argument);
  EXPECT_THROW(SeriesEnvelope(1, 1), std::invalid_argument);
  SeriesEnvelope envelope(2, 10);
  EXPECT_THROW(envelope.add(0, std::array{1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace libslam
