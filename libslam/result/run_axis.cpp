#include <algorithm>

#include <libslam/result/run_axis.hpp>

namespace libslam {

RunAxis::RunAxis(std::span<const EstimatedPose> path) : path_(path) {
  if (path.empty()) return;
  start_ = path.front().time;
  std::size_t later = 0;
  for (std::size_t i = 1; i < path.size(); ++i) later += path[i].time > path[i - 1].time;
  is_time_ = 10 * later >= 9 * (path.size() - 1);
}

double RunAxis::at_step(std::int64_t step) const {
  if (!is_time_) return static_cast<double>(step);
  const auto after =
      std::upper_bound(path_.begin(), path_.end(), step,
                       [](std::int64_t s, const EstimatedPose& p) { return s < p.step; });
  return at(after == path_.begin() ? *after : *(after - 1));
}

}  // namespace libslam
