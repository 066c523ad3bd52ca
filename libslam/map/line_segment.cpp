#include <cmath>

#include <libslam/map/line_segment.hpp>

namespace libslam {

std::optional<LineSegment> segment_of(const LandmarkEstimate& landmark) {
  if (landmark.type != "line" || landmark.mean.size() != 2 || !landmark.extent) return std::nullopt;
  const Eigen::Vector2d normal(std::cos(landmark.mean[0]), std::sin(landmark.mean[0]));
  const Eigen::Vector2d along(-normal.y(), normal.x());
  const Eigen::Vector2d foot = landmark.mean[1] * normal;
  return LineSegment{foot + landmark.extent->begin * along, foot + landmark.extent->end * along};
}

}  // namespace libslam
