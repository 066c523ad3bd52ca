#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <libslam/result/series_envelope.hpp>

namespace libslam {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// fmin and fmax return the other argument where one is NaN.
void widen(SeriesEnvelope::Range& range, float low, float high) {
  range.low = std::fmin(range.low, low);
  range.high = std::fmax(range.high, high);
}

}  // namespace

SeriesEnvelope::SeriesEnvelope(std::size_t channels, std::size_t capacity)
    : channels_(channels), capacity_(capacity) {
  if (channels < 1 || capacity < 2)
    throw std::invalid_argument("an envelope needs a channel and room for two buckets");
}

void SeriesEnvelope::add(double abscissa, std::span<const double> values) {
  if (values.size() != channels_)
    throw std::invalid_argument("an envelope of " + std::to_string(channels_) +
                                " channels got a sample of " + std::to_string(values.size()));
  if (abscissas_.empty() || samples_in_last_ == samples_per_bucket_) {
    if (abscissas_.size() == capacity_) merge_neighbours();
    if (abscissas_.empty() || samples_in_last_ == samples_per_bucket_) {
      abscissas_.push_back(abscissa);
      ranges_.resize(ranges_.size() + channels_, {kNone, kNone});
      samples_in_last_ = 0;
    }
  }
  ++samples_in_last_;
  Range* last = &ranges_[ranges_.size() - channels_];
  for (std::size_t c = 0; c < channels_; ++c) {
    const auto value = static_cast<float>(values[c]);
    widen(last[c], value, value);
  }
}

void SeriesEnvelope::merge_neighbours() {
  const std::size_t pairs = (abscissas_.size() + 1) / 2;
  const bool odd = abscissas_.size() % 2 == 1;
  for (std::size_t i = 0; i < pairs; ++i) {
    abscissas_[i] = abscissas_[2 * i];
    for (std::size_t c = 0; c < channels_; ++c) {
      Range merged = range(2 * i, c);
      if (2 * i + 1 < abscissas_.size()) {
        const Range other = range(2 * i + 1, c);
        widen(merged, other.low, other.high);
      }
      ranges_[i * channels_ + c] = merged;
    }
  }
  abscissas_.resize(pairs);
  ranges_.resize(pairs * channels_);
  samples_in_last_ = odd ? samples_per_bucket_ : 2 * samples_per_bucket_;
  samples_per_bucket_ *= 2;
}

}  // namespace libslam
