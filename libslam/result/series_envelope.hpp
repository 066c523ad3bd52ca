#pragma once
// A long series in bounded memory: the smallest and largest value of each stretch of it.

#include <cstddef>
#include <span>
#include <vector>

namespace libslam {

/// Min/max envelope of several channels over a common abscissa. Starts with one bucket per sample;
/// whenever `capacity` buckets are full, neighbours are merged, so that between capacity/2 and
/// capacity buckets of equal sample count remain and no extreme value is lost. NaN means "no value"
/// and is left out; a bucket without any value keeps NaN.
class SeriesEnvelope {
 public:
  struct Range {
    float low, high;  ///< single precision: the envelope is for plots
  };

  /// Throws std::invalid_argument where `channels` or `capacity` < 2 is not usable.
  SeriesEnvelope(std::size_t channels, std::size_t capacity);

  /// Appends one sample. Throws std::invalid_argument where the number of channels is wrong.
  void add(double abscissa, std::span<const double> values);

  std::size_t size() const { return abscissas_.size(); }
  std::size_t channels() const { return channels_; }
  /// Abscissa of the first sample of a bucket.
  double abscissa(std::size_t bucket) const { return abscissas_[bucket]; }
  Range range(std::size_t bucket, std::size_t channel) const {
    return ranges_[bucket * channels_ + channel];
  }

 private:
  void merge_neighbours();

  std::size_t channels_, capacity_;
  std::size_t samples_per_bucket_ = 1, samples_in_last_ = 0;
  std::vector<double> abscissas_;
  std::vector<Range> ranges_;  // bucket-major
};

}  // namespace libslam
