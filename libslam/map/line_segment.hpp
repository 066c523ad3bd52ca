#pragma once
// What was seen of a line, in the world.

#include <optional>

#include <Eigen/Core>

#include <libslam/data/step_record.hpp>

namespace libslam {

struct LineSegment {
  Eigen::Vector2d from, to;  ///< [m], in the world
};

/// The ends of a landmark of the type "line", whose mean is (alpha [rad], r [m]) of its oriented
/// Hesse form (measurement/line.hpp); nothing of another landmark or without an extent.
std::optional<LineSegment> segment_of(const LandmarkEstimate& landmark);

}  // namespace libslam
