#pragma once
// Times of a log whose order can be trusted more than its clock.

#include <cstddef>
#include <deque>
#include <optional>

namespace libslam {

/// Makes the times of entries non-decreasing without changing their order: an entry with a later
/// time than one that follows it was stamped late, and gets a time between its good neighbours.
/// Looks `kWindow` entries ahead, and no further, so that memory is bounded.
///
/// (In the Intel log of the Radish repository every 14th stamp is up to 0.9 s late; in the order of
/// its stamps the robot would have driven 661 m, in the order of the file 508 m.)
class MendedClock {
 public:
  static constexpr std::size_t kWindow = 256;
  /// A stamp that is late by more [s] is not a late stamp but a clock that was set.
  static constexpr double kLargestDelay = 2.0;

  /// The next entry. False if its time goes back too far for any mending.
  bool push(double time);
  /// The mended time of the oldest entry, if it is settled or `at_end`; each entry comes once, in
  /// order.
  std::optional<double> pop(bool at_end);

 private:
  struct Entry {
    double time;
    bool late;
  };
  double mended_front() const;

  std::deque<Entry> entries_;
  std::optional<double> last_;  // time of the entry popped last
};

}  // namespace libslam
