#include <algorithm>

#include <libslam/io/importers/mended_clock.hpp>

namespace libslam {

bool MendedClock::push(double time) {
  if (last_ && time < *last_) return false;
  for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) {
    if (entry->time > time + kLargestDelay) return false;
    entry->late = entry->late || entry->time > time;
  }
  entries_.push_back({time, false});
  return true;
}

std::optional<double> MendedClock::pop(bool at_end) {
  if (entries_.empty() || (entries_.size() < kWindow && !at_end)) return std::nullopt;
  last_ = entries_.front().late ? mended_front() : entries_.front().time;
  entries_.pop_front();
  return last_;
}

/// The newest entry is never late, so that there is a good one to go towards.
double MendedClock::mended_front() const {
  const auto good =
      std::find_if(entries_.begin(), entries_.end(), [](const Entry& e) { return !e.late; });
  if (!last_) return good->time;
  return *last_ + (good->time - *last_) / static_cast<double>(good - entries_.begin() + 1);
}

}  // namespace libslam
