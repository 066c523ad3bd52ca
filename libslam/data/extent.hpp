#pragma once
// The part of a line that was seen.

#include <algorithm>

namespace libslam {

/// From `begin` to `end` along a line [m], measured from the foot of the normal of its frame; a
/// quarter turn left of the normal is positive. begin <= end.
struct Extent {
  double begin = 0.0, end = 0.0;
  double sigma_begin = 0.0, sigma_end = 0.0;  ///< how well each end is known along the line [m]

  double length() const { return end - begin; }
  /// The distance between two parts of one line, negative where they overlap.
  double gap_to(const Extent& other) const {
    return std::max(begin, other.begin) - std::min(end, other.end);
  }
  /// Grows to hold `other`, too; an end that moves takes its uncertainty from there.
  void include(const Extent& other) {
    if (other.begin < begin) {
      begin = other.begin;
      sigma_begin = other.sigma_begin;
    }
    if (other.end > end) {
      end = other.end;
      sigma_end = other.sigma_end;
    }
  }
};

}  // namespace libslam
