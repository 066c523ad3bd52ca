#pragma once
// Numbers of sensors: noise is adapted per channel.

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace libslam {

/// Labels are numbered from 0 in order of appearance; beyond a hundred they share the last number,
/// because labels come from the log.
class ChannelNumbers {
 public:
  int of(const std::string& label) {
    const auto known = std::find(labels_.begin(), labels_.end(), label);
    if (known == labels_.end() && labels_.size() < kMost) {
      labels_.push_back(label);
      return static_cast<int>(labels_.size()) - 1;
    }
    return std::min(static_cast<int>(known - labels_.begin()), static_cast<int>(kMost) - 1);
  }

 private:
  static constexpr std::size_t kMost = 100;
  std::vector<std::string> labels_;
};

}  // namespace libslam
